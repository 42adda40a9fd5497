"""Wave numbers around an axis, as a parameter of problems, and the names of their eigenvalues."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Annotated

from pydantic import BeforeValidator, Field

from weakforms.errors import InputError
from weakforms.problems.column import Column, derived, numbers

MOST_WAVES = 400
"""Largest wave number that can be requested; larger ones were not tested on the default meshes."""


def wave_numbers(most: int) -> BeforeValidator:
    """Validator of wave numbers up to a largest one: a list, one number, or text such as ``20,50``."""
    wanted = f"whole numbers from 0 to {most} are wanted, such as {'20,50' if most > 50 else '0,1,2'}"

    def given(value: object) -> object:
        """Wave numbers without repetition."""
        items = value.split(",") if isinstance(value, str) else value
        found = []
        for item in items if isinstance(items, list | tuple) else [items]:
            try:
                number = float(item)  # type: ignore[arg-type]
            except (TypeError, ValueError):
                raise ValueError(wanted) from None
            if isinstance(item, bool) or number not in range(most + 1):
                raise ValueError(wanted)
            found.append(int(number))
        return tuple(dict.fromkeys(found))

    return BeforeValidator(given)


LOWEST = 3
"""Number of eigenvalues in results for each wave number."""

EIGENVALUE = re.compile(r"Lambda_n(\d+)_(\d+)")


def eigenvalue_names(n: int) -> list[str]:
    """Names of the lowest eigenvalues of a wave number."""
    return [f"Lambda_n{n}_{k}" for k in range(1, LOWEST + 1)]


def eigenvalue_columns(most: int, mass: str, whole: str) -> tuple[Column, ...]:
    """Declarations of the eigenvalues of all wave numbers.

    Args:
        most: Largest wave number.
        mass: The integral against which eigenvalues are.
        whole: What else the axisymmetric ones are of.
    """
    return tuple(
        Column(
            name,
            f"eigenvalue {k} in ascending order at fixed p against {mass}, "
            + (f"{n} wave{'s' if n > 1 else ''} around" if n else f"axisymmetric without torsion, {whole}"),
        )
        for n in range(most + 1)
        for k, name in enumerate(eigenvalue_names(n), 1)
    )


def count_columns(most: int, whole: str) -> tuple[Column, ...]:
    """Declarations of the numbers of negative eigenvalues of all wave numbers.

    Args:
        most: Largest wave number.
        whole: What the axisymmetric ones are of.
    """
    return derived(
        *numbers(
            n_negative_volume=f"number of negative eigenvalues at fixed volume, axisymmetric, {whole}",
            **{
                f"n_negative_n{n}": "number of negative eigenvalues at fixed p, "
                + (
                    f"{n} wave{'s' if n > 1 else ''} around (each of them twice: cos and sin)"
                    if n
                    else f"axisymmetric, {whole}"
                )
                for n in range(most + 1)
            },
        )
    )


def require_waves(problem: str, n: tuple[int, ...], wanted: Iterable[str]) -> None:
    """Refuse eigenvalues of wave numbers that are not computed.

    Args:
        problem: Name of the problem.
        n: Wave numbers that are computed.
        wanted: Names by which states are requested.

    Raises:
        InputError: For a name that is none of theirs.
    """
    known = [name for waves in n for name in eigenvalue_names(waves)]
    for name in wanted:
        if EIGENVALUE.fullmatch(name) and name not in known:
            listed = ", ".join(known) or "none"
            raise InputError(
                f"{problem}: cannot ask for a state at {name!r}; allowed eigenvalues: {listed} "
                f"(n = {','.join(map(str, n)) or '()'} sets the wave numbers)"
            )


WaveNumbers = Annotated[tuple[Annotated[int, Field(ge=0, le=MOST_WAVES)], ...], wave_numbers(MOST_WAVES)]
"""Parameter ``n``: wave numbers around the axis for which stability is computed."""
