"""Further facts on problems for the documentation: unknowns, forms, an example, a picture.

A picture shows a solution: a branch of the example, or a quantity over a few values of one parameter.
"""

from __future__ import annotations

import importlib
import inspect
import textwrap
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from weakforms.verification.cases.specs import Spec

WEAK_FORM = (
    "find u = {unknown} such that dPi(u + e v)/de = 0 at e = 0 for every admissible v; the tangent is the "
    "second variation, both by ufl.derivative"
)


@dataclass(frozen=True)
class Shown:
    """The documentation of one problem."""

    unknown: str
    """The unknowns and their conditions."""
    forms: tuple[str, ...]
    """Functions that define the functional, ``module:name`` below ``weakforms``."""
    x: str
    """Abscissa of the picture: a column, or the parameter that is varied."""
    y: str
    """A column, or a quantity."""
    example: Mapping[str, Any] = field(default_factory=dict)
    """Parameters of the example that differ from their defaults."""
    values: tuple[float, ...] = ()
    """Values of the parameter; none for a branch of the example."""
    numerics: Mapping[str, Any] = field(default_factory=dict)
    """Meshes of the picture, coarser than the default ones."""

    def specs(self, problem: str) -> list[Spec]:
        """Solutions for the picture."""
        rows = [{self.x: value} for value in self.values] or [{}]
        numerics = tuple(sorted(self.numerics.items()))
        return [Spec(problem, tuple(sorted({**self.example, **row}.items())), numerics) for row in rows]


COARSE = {"cells": 24, "levels": 2}
ON_CIRCLE = "the position (x, y, z) over (Z, Theta), held on both rings"
AXISYMMETRIC = "(r, z) over the material coordinate Z, held at both disks"
HOMOGENEOUS = "the principal stretches of a homogeneous state"

SHOWN: dict[str, Shown] = {
    "circular": Shown(
        "(lam2, eta) over the radius x of the disk, rho = x lam2; both held at the clamp",
        ("forms.loads:gas_potential", "forms.loads:bed_potential", "forms.kinematics:disk_stretches"),
        *("p", "t0"),
        {"contact": "frictionless"},
        numerics=COARSE,
    ),
    "circular_scheme": Shown(
        "(rho, eta) over the radius of the disk, held at the clamp; rings in contact are frozen one by one",
        ("forms.loads:gas_potential", "forms.loads:bed_potential"),
        *("t_end", "p"),
        values=(0.51, 0.53, 0.55, 0.57),
        numerics={"cells": 100, "steps": 14},
    ),
    "material": Shown(
        HOMOGENEOUS + ", given",
        ("forms.materials.phenomenological:mooney_rivlin", "forms.wrinkling:tension_field"),
        *("l1", "W1"),
        values=tuple(1 + i / 4 for i in range(9)),
    ),
    "sphere": Shown(
        "the stretch of the balloon",
        ("forms.materials.phenomenological:mooney_rivlin", "problems.homogeneous.body:"),
        *("lam", "P"),
    ),
    "infinite_tube": Shown(
        HOMOGENEOUS,
        ("forms.materials.phenomenological:mooney_rivlin", "problems.homogeneous.body:"),
        *("lam2", "p"),
    ),
    "homogeneous": Shown(
        HOMOGENEOUS,
        ("forms.materials.phenomenological:mooney_rivlin", "problems.homogeneous.body:"),
        *("lam", "T"),
    ),
    "tube": Shown(
        "(rho, eta) over half the tube, held at the disk and symmetric at mid-length",
        ("problems.tube.model:potential", "forms.loads:gas_potential", "forms.loads:substrate_potential"),
        *("p", "u_max"),
        {"alpha": 0.1, "delta1": 1.1},
        numerics={"cells": 32, "levels": 2},
    ),
    "tube_fold": Shown(
        "(rho, eta) as of `tube` with p and delta1, and a null vector of the second variation",
        ("problems.tube.model:potential",),
        *("delta1", "p"),
        {"alpha": 0.1},
        numerics={"cells": 32, "levels": 2},
    ),
    "tube_scheme": Shown(
        "(rho, eta) over half the tube on a fixed mesh; nodes in contact stick, or slide on the spring",
        ("problems.tube.model:potential", "forms.loads:substrate_potential"),
        *("p_end", "u_max"),
        values=(1.5, 2.0, 2.5, 3.0),
        numerics={"cells": 60, "steps": 16},
    ),
    "fluid_tube": Shown(
        AXISYMMETRIC + "; waves around enter through the second variation of each wave number",
        ("forms.fluid:strain_energy", "forms.fluid:submerged_flux", "forms.fluid:pressure_work"),
        *("zw", "V"),
        {"L": 8, "delta": 2},
        numerics=COARSE,
    ),
    "fluid_tube_coincidence": Shown(
        AXISYMMETRIC + ", with the pre-stretch at which two second variations are singular at once",
        ("forms.fluid:strain_energy", "forms.fluid:submerged_flux"),
        *("gamma", "delta"),
        values=(0.1, 0.116, 0.13),
        numerics={"cells": 32, "levels": 2},
    ),
    "fluid_tube_surface": Shown(
        ON_CIRCLE,
        ("forms.fluid:strain_energy", "forms.fluid:submerged_flux"),
        *("delta", "zw_bifurcation"),
        values=(1.8, 2.0, 2.2),
        numerics={"cells": 8},
    ),
    "wrinkled_tube": Shown(
        AXISYMMETRIC,
        ("forms.wrinkling:tension_field", "forms.loads:liquid_potential", "forms.loads:gas_potential"),
        *("zw", "r_max"),
        {"M": 1.5, "delta": 2},
    ),
    "wrinkled_tube_threshold": Shown(
        AXISYMMETRIC + ", with the thickness ratio at which it is about to wrinkle",
        ("forms.wrinkling:natural_width", "forms.wrinkling:wrinkling_function"),
        *("delta", "M"),
        values=(1.5, 2.0, 2.5, 3.0, 3.5),
    ),
    "wrinkled_material": Shown(
        HOMOGENEOUS + ", given",
        ("forms.wrinkling:tension_field", "forms.wrinkling:modified_gradient"),
        *("l2", "W"),
        values=tuple(0.3 + i / 10 for i in range(13)),
    ),
    "wrinkled_sheet": Shown(
        "the position in space over a quarter of the unrolled cylinder, held at both disks",
        ("forms.wrinkling:surface_tension_field", "forms.fluid:submerged_flux"),
        *("at_load", "V"),
        values=(3.5, 4.0, 4.5),
        numerics={"along": 2, "around": 2},
    ),
    "wrinkled_linear": Shown(
        "waves around a wrinkled cylinder: second variation of its relaxed energy for a trial function",
        ("forms.revolution:second_order", "forms.revolution:strain_energy"),
        *("zw", "n_star"),
        values=(4.5, 5.0, 5.5),
        numerics={"levels": 2},
    ),
    "wrinkled_bending": Shown(
        "waves (u, beta, w) of wave number n around a wrinkled cylinder",
        ("forms.revolution:second_order", "forms.revolution:hoop_bending"),
        *("n", "Lambda_membrane"),
        values=(5.0, 10.0, 20.0),
        numerics={"levels": 2, "degree": 4},
    ),
    "wrinkled_patch": Shown(
        "the amplitude e of a displacement of a flat wrinkled patch",
        ("forms.wrinkling:tension_field",),
        *("e", "U"),
    ),
    "hemisphere": Shown(
        "(r, z) over the arc of the hemisphere, held at its equator",
        ("forms.revolution:strain_energy", "forms.revolution:liquid_energy"),
        *("zw", "V"),
    ),
    "surface": Shown(
        "the positions of the nodes of a triangulated surface, the edges held",
        ("forms.relaxed_surface:relaxed_energy", "forms.relaxed_surface:pressure_potential"),
        *("zw", "r_max"),
        {"meridional": 24, "circumferential": 12},
        numerics={"scan": 10, "shown": 1},
    ),
}
"""Documentation by name of the problem; it is optional."""


def weak_form(problem: str) -> str:
    """The weak form in words."""
    shown = SHOWN.get(problem)
    return WEAK_FORM.format(unknown=shown.unknown if shown else "the unknown")


def example(problem: str) -> list[str]:
    """Three lines of Python that solve the problem and print a result."""
    shown = SHOWN.get(problem)
    given = dict(shown.example) if shown else {}
    words = "".join(f", {name}={value!r}" for name, value in given.items())
    last = "print(result.branches, result.quantities)"
    if shown:
        columns = (
            f'result.branch("primary").columns["{shown.x}"], result.branch("primary").columns["{shown.y}"]'
        )
        last = f'print(result.quantities["{shown.y}"])' if shown.values else f"print({columns})"
    return ["import weakforms", f'result = weakforms.solve("{problem}"{words})', last]


def command(problem: str) -> str:
    """The example as a shell command."""
    shown = SHOWN.get(problem)
    sets = "".join(f" --set {k}={v}" for k, v in (shown.example if shown else {}).items())
    return f"./run solve {problem}{sets} --out {problem}.json"


def written_forms(problem: str) -> list[tuple[str, Any, str]]:
    """The functions that define a problem's functional: name, function or module, and source.

    For a module (``module:``) there is no source, only its docstring.
    """
    out = []
    shown = SHOWN.get(problem)
    for place in shown.forms if shown else ():
        module, _, name = place.partition(":")
        found = importlib.import_module(f"weakforms.{module}")
        what = getattr(found, name) if name else found
        out.append((f"weakforms.{module}{'.' * bool(name)}{name}", what, _body(what) if name else ""))
    return out


def _body(function: Any) -> str:
    """Source of a function without its docstring."""
    source = textwrap.dedent(inspect.getsource(function))
    docstring = function.__doc__
    if docstring:
        start = source.find('"""')
        end = source.find('"""', start + 3) + 3
        begin = source.rfind("\n", 0, start)
        source = source[:begin] + source[end:]
    return source.strip()
