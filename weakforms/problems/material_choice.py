"""The parameters of all problems that choose the material law: ``model`` and the constants of the law."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Literal

from dolfinx import fem
from dolfinx.mesh import Mesh
from pydantic import Field, SerializerFunctionWrapHandler, model_serializer, model_validator
from ufl.core.expr import Expr

from weakforms.errors import InputError
from weakforms.forms.materials import MATERIALS, Material, SurfaceLaw, surface_law
from weakforms.forms.materials.surface import LAWS
from weakforms.problems.problem import Parameters, TogetherError

MOONEY_RIVLIN = "mooney_rivlin"


@dataclass(frozen=True)
class Chosen:
    """A law with the values of its constants, as an immutable value."""

    model: str
    constants: tuple[tuple[str, float], ...]

    @property
    def material(self) -> Material:
        """The law's entry in the catalogue."""
        return MATERIALS[self.model]

    def on(self, mesh: Mesh) -> dict[str, fem.Constant]:
        """The law with the constants of a form, so that forms are compiled once for each law."""
        return {name: fem.Constant(mesh, value) for name, value in self.constants}

    def law(self, mesh: Mesh) -> Callable[[Expr, Expr], Expr]:
        """The energy as a function of the two principal stretches."""
        return self.material.energy(self.on(mesh))

    def surface_law(self, mesh: Mesh) -> SurfaceLaw:
        """The energy of a surface: of its principal stretches, and of the invariants of its metric."""
        return surface_law(self.model, self.on(mesh))


def mooney_rivlin_of(ratio: float) -> Chosen:
    """The Mooney-Rivlin law of the papers."""
    return Chosen(MOONEY_RIVLIN, (("alpha", float(ratio)),))


class MaterialChoice(Parameters):
    """``model`` and its constants, which are parameters with their own names.

    If the paper's problem has a Mooney-Rivlin membrane, the subclass gives in ``ratio`` the name of the
    parameter C2/C1, which then is that law's constant. In a result the constants are among the parameters.
    """

    ratio: ClassVar[str] = ""

    model: Literal[*MATERIALS] = Field(MOONEY_RIVLIN, description="law: see weakforms show material")
    constants: tuple[tuple[str, float], ...] = Field(
        (), description="constants of the law, each set by its own name"
    )

    @classmethod
    def further(cls) -> frozenset[str]:
        """Names of the constants of all laws."""
        return frozenset(name for material in MATERIALS.values() for name in material.constants)

    @model_validator(mode="before")
    @classmethod
    def _collect(cls, given: Any) -> Any:
        """Collect constants by name into one value, and check each range and the whole set."""
        name = given.get("model", MOONEY_RIVLIN) if isinstance(given, Mapping) else None
        if not isinstance(name, str) or name not in MATERIALS:
            return given  # the field's own check refuses it
        material = MATERIALS[name]
        if "constants" in given:
            raise TogetherError("set the constants by their own names, not by 'constants'")
        own = {n: c for n, c in material.constants.items() if material.name != MOONEY_RIVLIN or not cls.ratio}
        fields = set(cls.model_fields) - ({cls.ratio} if material.name != MOONEY_RIVLIN else set())
        rest = {name: value for name, value in given.items() if name in fields}
        for name in given:
            if name not in own and name not in fields:
                known = ", ".join(own) or cls.ratio or "none"
                raise TogetherError(
                    f"{name} is not a constant of model = {material.name!r}, which has: {known}"
                )
        values = {
            name: _value(name, given.get(name, c.default), c.allowed, c.contains) for name, c in own.items()
        }
        wrong = material.refusal(values) if values else ""
        if wrong:
            raise TogetherError(f"model = {material.name!r}: {wrong}")
        return {**rest, "constants": tuple(values.items())}

    @model_serializer(mode="wrap")
    def _flat(self, handler: SerializerFunctionWrapHandler) -> dict[str, Any]:
        """The parameters as given: constants by name, without the ratio if the law does not use it."""
        data = handler(self)
        constants = dict(data.pop("constants"))
        if self.model != MOONEY_RIVLIN:
            data.pop(self.ratio, None)
        return {**data, **constants}

    @property
    def other_law(self) -> Chosen | None:
        """The chosen law, unless it is the Mooney-Rivlin law."""
        return None if self.model == MOONEY_RIVLIN else self.material

    @property
    def material(self) -> Chosen:
        """The chosen law."""
        if self.model == MOONEY_RIVLIN and self.ratio:
            return mooney_rivlin_of(getattr(self, self.ratio))
        return Chosen(self.model, self.constants)


def require_foldable(
    what: str, parameters: MaterialChoice, invariants: bool, others: Collection[str] = ()
) -> None:
    """Refuse a law for which there is no form of a wrinkled membrane.

    Natural width and wrinkling function hold for incompressible laws only; waves around an axis and
    triangles in space need the law as a function of the invariants.

    Args:
        what: The problem, for the message.
        parameters: Its parameters.
        invariants: Whether a function of the invariants is needed.
        others: Compressible laws for which the problem has a natural width.

    Raises:
        InputError: With a message that names the allowed laws.
    """
    allowed = [name for name, m in MATERIALS.items() if m.incompressible and (not invariants or name in LAWS)]
    require_model(what, parameters, [*allowed, *others])


def require_model(what: str, parameters: MaterialChoice, allowed: Collection[str]) -> None:
    """Refuse a law for which a problem has no valid form.

    Raises:
        InputError: With a message that names the allowed laws.
    """
    if parameters.model not in allowed:
        raise InputError(f"{what}: model = {parameters.model!r}; allowed: {', '.join(allowed)}")


def _value(name: str, given: Any, allowed: str, contains: Callable[[float], bool]) -> float:
    try:
        value = float(given if not isinstance(given, bool) else "no number")
    except (TypeError, ValueError):
        value = float("nan")
    if not contains(value):
        raise TogetherError(f"{name} = {given!r}: must be a number {allowed}")
    return value
