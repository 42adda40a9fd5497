"""Writes a deck: a folder with mesh, input or script, the numbers to expect, and how to get a verdict."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from weakforms.decks import calculix, febio, surfaces
from weakforms.decks.bodies import Body, body_of
from weakforms.decks.expected import BULK, STEPS, WALL, Expected, expected, solved, validated
from weakforms.decks.meshes import Wall, cells_along, section, surface_mesh, wall
from weakforms.decks.stages import Stage, stages_of
from weakforms.errors import InputError, not_among
from weakforms.results import Result
from weakforms.terminal import rank

SCRIPTS = Path(__file__).with_name("scripts")

CODES = {
    "calculix": ("ccx deck && python3 curve.py", "section"),
    "febio": ("febio4 -i deck.feb && python3 curve.py", "wall"),
    "ngsolve": ("python3 deck.py", "surface"),
    "sfepy": ("python3 deck.py", "facets"),
    "gmsh": ("gmsh deck.msh", "surface"),
}
"""The codes, each with the command that runs its deck, and the kind of its mesh."""

WITHOUT_TENSION_FIELD = ("calculix", "febio", "sfepy")
"""Codes whose deck bears compression, and has gas only."""

SURFACES = ("surface", "facets")
"""Kinds of mesh that are a membrane: of curved triangles, or of each of these as four flat ones."""

UNITS = "lengths and pressures in the problem's own scaling, in which C1 h = 1"


def way(code: str, body: Body) -> str:
    """The kind of mesh: a wrinkled tube is in space for every code."""
    return "wall" if (code, body.problem) == ("calculix", "wrinkled_tube") else CODES[code][1]


def require_code(code: str, problem: str, values: Mapping[str, Any]) -> None:
    """Refuse codes without decks, and bodies that a code cannot have.

    Raises:
        InputError: With a message that says what is allowed.
    """
    if code not in CODES:
        raise InputError(f"--for {code!r}: there is no deck for it{not_among(code, CODES, 'decks are for')}")
    if problem == "wrinkled_tube" and code in WITHOUT_TENSION_FIELD and values["load"] != "gas":
        raise InputError(f"deck wrinkled_tube --for {code}: it has no fluid; allowed: load=gas")


def require_taut(problem: str, code: str, result: Result) -> None:
    """Refuse a solid wall of a membrane that wrinkles: it bears compression, and would buckle.

    Raises:
        InputError: If a state is wrinkled.
    """
    for state in result.states:
        least = state.quantities.get("gw_min")
        if least is not None and least.value < 1:
            raise InputError(
                f"deck {problem} --for {code}: the membrane is wrinkled at {state.at} (gw_min = "
                f"{least.value:.3g}), so that a wall buckles; choose another load or Af, or --for ngsolve"
            )


def write_deck(
    problem: str,
    code: str,
    at: tuple[str, float],
    folder: Path,
    parameters: Mapping[str, Any],
    cells: int = 0,
    progress: Any = None,
) -> Expected:
    """Write a deck into a folder, which is made; it appears only when complete.

    Args:
        problem: ``tube``, ``circular``, ``sphere`` or ``wrinkled_tube``.
        code: One of ``CODES``.
        at: Name of the load, and its last value.
        folder: Where to write; it must not exist, or be empty.
        parameters: Parameters of the problem that differ from their defaults.
        cells: Even number of cells along the meridian; 0 leaves it to the deck.
        progress: Called with the current step, the amount of work done and the total amount.

    Returns:
        What to expect of it.

    Raises:
        InputError: For bad input; nothing is written.
        ConvergenceError: If the solution did not converge.
        EnvironmentLackError: Without DOLFINx.
    """
    if cells and (cells % 2 or not 8 <= cells <= 400):
        raise InputError(f"--cells {cells}: must be even, from 8 to 400")
    if code not in CODES:
        require_code(code, problem, {})
    values = validated(problem, parameters, *at)
    require_code(code, problem, values)
    if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
        raise InputError(f"{folder} exists already and is not an empty folder")
    result = solved(problem, parameters, *at, progress)
    constants = {"alpha": 0.0} | {k: v for k, v in result.parameters.items() if v is not None}
    critical = result.quantities.get("Af_critical")
    if constants.get("load") == "fluid" and "gamma" not in constants:
        from weakforms.problems.wrinkled.problem import PAPER_GAMMA

        constants["gamma"] = PAPER_GAMMA
    if code in WITHOUT_TENSION_FIELD:
        require_taut(problem, code, result)
    body = body_of(problem, {**values, **constants}, float(critical.value) if critical else 1.0)
    cells = cells or cells_along(body)
    found = expected(result, body, cells, way(code, body))
    if rank() == 0:
        _write(folder, _files(code, found, cells))
    return found


def _write(folder: Path, files: Mapping[str, str]) -> None:
    """Write files into a folder, which appears only when they are complete.

    Raises:
        InputError: If that is not possible.
    """
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent, prefix=f".{folder.name}.") as scratch:
            ready = Path(scratch) / "deck"
            ready.mkdir()
            for name, text in files.items():
                (ready / name).write_text(text, encoding="utf-8")
            ready.replace(folder)  # an empty folder of that name is replaced
    except OSError as error:
        raise InputError(f"cannot write {folder}: {error.strerror or error}") from error


def _files(code: str, found: Expected, cells: int) -> dict[str, str]:
    """Names and texts of the files of a deck."""
    from weakforms.results.io import dumps

    body = found.body
    stages = stages_of(body, found.loads)
    kind = way(code, body)
    about = _about(found, code)
    mid = surface_mesh(body, cells, kind not in SURFACES) if kind != "section" else None
    solid = section(body, cells, WALL) if mid is None else wall(mid, WALL)
    shared = {"expected.json": dumps(found.result.to_json()), "reading.py": _script("reading")}
    if code == "calculix":
        own = {
            "deck.inp": calculix.input_file(body, solid, stages, about),
            "curve.py": _script("calculix_curve"),
        }
    elif code == "febio":
        own = {"deck.feb": febio.input_file(body, solid, stages, about), "curve.py": _script("febio_curve")}
    else:
        own = {"deck.msh": surfaces.msh(body, mid)}
        if code != "gmsh":
            own["deck.py"] = _script(f"{code}_deck")
        else:
            del shared["reading.py"]
    facts = _facts(found, code, stages, solid)
    return {**own, **shared, "deck.json": json.dumps(facts, indent=1) + "\n", "README.txt": about}


def _script(name: str) -> str:
    return (SCRIPTS / f"{name}.py").read_text(encoding="utf-8")


def verdict(found: Expected) -> str:
    """The command that judges the curve of a deck."""
    body = found.body
    return (
        f"weakforms compare {body.problem} curve.csv --with expected.json --over {body.over} "
        f"--column {body.load}" + (f" --accuracy {found.claim:.0e}" if found.claim else "")
    )


def _facts(found: Expected, code: str, stages: list[Stage], solid: Wall) -> dict[str, Any]:
    body = found.body
    # Number and place of the nodes of each station along the meridian: of a wall the inner and the outer one.
    stations = [
        [[int(n) + 1 for n in pair], [[float(x) for x in solid.points[n]] for n in pair]]
        for pair in solid.stations
    ]
    return {
        "schema": "weakforms.deck/1",
        "problem": body.problem,
        "parameters": found.result.parameters,
        "for": code,
        "units": UNITS,
        "law": {
            "C2/C1": body.ratio,
            "relaxed": body.relaxed,
            "wall": WALL,
            "C1": 1 / WALL,
            "bulk modulus": BULK / WALL,
        },
        "load": {"name": body.load, "gamma": body.gamma},
        "over": body.over,
        "pole": body.pole,
        "mirror": body.mirror,
        "thickness": _thickness(body),
        "clamps": [{"edge": f"clamp{c.end}", "radius": c.radius, "height": c.height} for c in body.clamps],
        "axis": solid.points.shape[1] - 1,
        "stages": [stage.row() for stage in stages],
        "stations": stations,
        "expected": [
            {"load": float(p), "value": float(v), "uncertainty": float(u)}
            for p, v, u in zip(found.loads, found.values, found.uncertainty, strict=True)
        ],
        "errors": found.errors,
        "accuracy": found.claim,
        "verdict": verdict(found),
    }


def _thickness(body: Body) -> dict[str, str | float]:
    """The thickness over its mean, which is linear in a coordinate of the meridian at rest."""
    ends = np.array([0.0, 1.0])
    first, last = body.thickness(ends)
    over = body.meridian(ends)[0 if body.pole else 1]
    slope = float((last - first) / (over[1] - over[0]))
    return {"over": "r" if body.pole else "z", "at zero": float(first - slope * over[0]), "slope": slope}


def _about(found: Expected, code: str) -> str:
    body, last = found.body, -1
    given = ", ".join(f"{k} = {v}" for k, v in found.result.parameters.items() if v is not None)
    parts = "".join(f"  {name:14s} {value:.1e}\n" for name, value in found.errors.items())
    value, doubt = found.values[last], found.uncertainty[last]
    return (
        f"Deck of weakforms for {code}: {body.problem}\n{given}\n\n"
        f"Units: {UNITS}.\n"
        f"Run:     {CODES[code][0]}\n"
        + (f"Verdict: {verdict(found)}\n\n" if code != "gmsh" else "\n")
        + f"Number to expect at {body.load} = {found.loads[last]:.6g}, reached in {STEPS} equal steps:\n"
        f"  {body.over} = {value:.12g} +- {doubt:.1e} (converged solution)\n"
        + (
            f"Errors to expect of {body.load} at this {body.over}, relative:\n{parts}"
            f"An accuracy to claim: {found.claim:.0e} (twice their sum).\n"
            if found.claim
            else "The errors of this mesh are not known. Run it with twice as many --cells too.\n"
        )
    )
