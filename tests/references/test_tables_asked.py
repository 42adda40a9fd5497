"""What every table asks for, against what is committed; no table is computed."""

import tomllib
from pathlib import Path

import numpy as np
import pytest
from unsolved import Asked, requests, same

from reference_data.solvers.registry import tables

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "reference_data"
FOLDERS = [folder for folder in DATA.glob("solvers/*") if folder.name != "core"]
MODULES = sorted(p.relative_to(DATA / "solvers") for f in FOLDERS for p in f.glob("tables*.py"))
TEXTS = ("title", "source", "method", "grid", "tolerance", "notes", "abscissa")

UNFINISHED = {
    "beyond.bent_tube.tables.folds",
    "beyond.filled_disk.tables.extremum",
    "beyond.lopsided.tables.limits",
    "beyond.lopsided.tables_uneven.extrema",
    "beyond.relaxed.tables.branch",
    "beyond.relaxed.tables_liquid.branch",
    "beyond.tables_airbag.curve",
    "beyond.tables_controls.mass_folds",
    "beyond.tables_tube_bends.limit_points",
    "beyond.tables_tube_bends.waves",
    "beyond.tables_tube_bends.wrinkling",
    "beyond.torus.tables_waves.eigenvalues",
    "beyond.torus.tables_waves.points",
    "materials.tables_disk.limits",
    "materials.tables_liquid_tube.points",
    "paper1.tables_contact.frictionless",
    "paper1.tables_free.limit_points",
    "paper1.tables_free.small",
    "paper1.tables_peeling.release_start",
    "paper2.tables_checks.ftim_state",
    "paper2.tables_contact.onset",
    "paper2.tables_contact_checks.ftim_contact_state",
    "paper2.tables_free.fold_line",
    "paper3.tables_critical.crossings",
    "paper3.tables_critical.points",
    "paper3.tables_secondary.state",
    "paper4.tables_uneven.disk",
    "paper5.tables_bending.window",
}
"""Builders that cannot go on to the table without a solution; what they chose before is compared."""
ANSWERS = {"fronts", "jump", "observed_orders", "stable_levels_between", "zones"}
"""Parts of tables that are solutions, wherever they occur."""
FOUND = {
    "beyond.tables_lines.turns": {"order"},
    "closed_form.tables.sphere_limits": {"order"},
    "closed_form.tables.tube_limits": {"order"},
    "paper2.tables_free.cusps": {"alpha", "lf", "notes"},
    "paper2.tables_free.limits": {"alpha", "delta1", "lf", "notes", "order"},
    "paper4.tables_branches.fronts": {"columns"},
    "paper4.tables_crests.crests": {"M", "delta", "order", "p"},
    "paper4.tables_statements.front_jumps": {"order", "state"},
}
"""Parts that depend on how many points, fronts or crests a solution has, by builder."""
UNTOUCHED = {"title", "notes", "parameters"}
"""Parts of the profiles of a disk that say whether it touches the substrate."""


@pytest.fixture(scope="module")
def asked() -> dict[str, Asked]:
    with np.errstate(all="ignore"):
        return requests()


def differences(name: str, request: Asked) -> list[str]:
    """Parts of a table that its builder asks for otherwise than the committed one says."""
    path = DATA / request.folder / f"{name}.toml"
    about = tomllib.loads(path.read_text("utf-8"))
    head, *rows = path.with_suffix(".csv").read_text("utf-8").splitlines()
    numbers = np.array([[float(x) for x in row.split(",")] for row in rows])
    committed = dict(zip(head.split(","), numbers.T, strict=True))
    out, table = [], request.table
    if table is not None:
        said = {key: getattr(table, key) for key in TEXTS} | {
            "type": table.kind,
            "parameters": table.parameters,
        }
        out += sorted(set(about) - set(said) - set(table.extra) - {"columns", "regenerate", "sha256"})
        out += [key for key, value in (said | table.extra).items() if not same(value, about.get(key, ""))]
        names = [c.name for c in table.columns if isinstance(c.name, str)]
        whole = len(names) == len(table.columns)
        out += [] if (names == list(committed) if whole else set(names) <= set(committed)) else ["columns"]
    for column in request.chosen if table is None else table.columns:
        if isinstance(column.name, str) and column.name in committed:
            texts = about["columns"][column.name]
            good = same([column.scaling, column.meaning], [texts["scaling"], texts["meaning"]])
            if not (good and as_committed(column.values, committed[column.name])):
                out.append(column.name)
        elif isinstance(column.name, str):
            out.append("columns")
    found = ANSWERS | FOUND.get(request.builder, set())
    if request.builder == "paper1.tables_profiles.profile" and about["parameters"]["contact"] == "none":
        found |= UNTOUCHED
    return [f"{name}: {part}" for part in out if part not in found]


def as_committed(values: object, committed: np.ndarray) -> bool:
    """Whether chosen values are those of the table; what depends on a solution is not known."""
    numbers = np.ravel(np.asarray(values, dtype=float))
    if not numbers.size or not np.isfinite(numbers).all():
        return True
    return (
        len(numbers) == len(committed) and np.abs(numbers - committed).max() <= 1e-11 * np.abs(numbers).max()
    )


@pytest.mark.parametrize("module", MODULES, ids=lambda p: p.with_suffix("").as_posix())
def test_tables_ask_for_what_is_committed(asked, module):
    """Titles, parameters, abscissae, keys and columns of every table of a module."""
    prefix = module.with_suffix("").as_posix().replace("/", ".") + "."
    own = {name: request for name, request in asked.items() if request.builder.startswith(prefix)}
    assert own
    assert [text for name, request in own.items() for text in differences(name, request)] == []


def test_tables_are_built_without_solutions_but_for_a_few(asked):
    assert set(asked) == set(tables())
    assert {request.builder for request in asked.values() if request.table is None} == UNFINISHED
