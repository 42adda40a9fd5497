"""Both methods of a table share numerics of the core and the material law, and no equation."""

import ast
from pathlib import Path

import pytest

SOLVERS = Path(__file__).resolve().parents[3] / "reference_data" / "solvers"
PREFIX = "reference_data.solvers."
FIRST = (
    *("paper1/shooting/*", "paper2/differences/*", "paper2/ftim", "paper3/weak", "paper3/galerkin"),
    *("paper3/bent/equations", "paper3/bent/newton", "paper3/bent/states", "paper4/methods/differences"),
    *("paper4/methods/shooting", "paper4/methods/shooting_newton"),
    *("paper5/waves/transfer", "paper5/waves/shots", "paper5/bloch", "beyond/tube_waves/ritz"),
    "beyond/caps/shooting",
)
"""Differences, shooting, Galerkin's method and transfer matrices."""
SECOND = (
    *("paper1/collocation/*", "paper2/collocation/*", "paper3/collocation", "paper3/canonical"),
    *("paper3/strong/*", "paper4/methods/collocation", "paper4/methods/states"),
    *("paper5/waves/second_variation", "paper5/bloch_metric", "beyond/tube_waves/strong"),
    "beyond/caps/energy",
)
"""Collocation, and what is derived from it."""
INTERPOLATION = {"lagrange", "differentiation", "Array"}
"""What first methods may use of the collocation core: polynomials, not its equations' solution."""
SHARED = {
    ("paper3/strong/equations", "paper3/bent/newton"),
    ("paper3/strong/states", "paper3/bent/newton"),
    ("paper4/methods/states", "paper4/methods/differences"),
    ("paper5/bloch_metric", "paper5/bloch"),
}
"""Elimination inside elements, first guesses of the pattern of zones, and the description of a mesh."""


def modules(*patterns: str) -> dict[str, Path]:
    found = {}
    for pattern in patterns:
        paths = [p for p in SOLVERS.glob(f"{pattern}.py") if p.name != "__init__.py"]
        assert paths, pattern
        found |= {p.relative_to(SOLVERS).with_suffix("").as_posix(): p for p in paths}
    return found


def imported(path: Path) -> set[tuple[str, str]]:
    """(module, name) of everything taken from the reference side, modules as paths."""
    out = set()
    for node in ast.walk(ast.parse(path.read_text("utf-8"))):
        if isinstance(node, ast.ImportFrom) and (node.module or "").startswith(PREFIX):
            base = node.module.removeprefix(PREFIX).replace(".", "/")
            for alias in node.names:
                whole = f"{base}/{alias.name}"
                out.add((whole, "") if (SOLVERS / f"{whole}.py").exists() else (base, alias.name))
    return out


@pytest.mark.parametrize(("own", "other"), [(FIRST, SECOND), (SECOND, FIRST)], ids=["first", "second"])
def test_no_method_imports_the_other(own, other):
    known = modules(*other)
    taken = {
        (name, base) for name, path in modules(*own).items() for base, _ in imported(path) if base in known
    }
    assert taken <= SHARED


def test_first_methods_do_not_solve_by_the_collocation_core():
    """Else a fault of the core would make two methods agree on a wrong number."""
    for name, path in modules(*FIRST).items():
        used = {item for base, item in imported(path) if base == "core/collocation"}
        assert used <= INTERPOLATION, name


@pytest.mark.parametrize("name", ["core/newton", "core/collocation"])
def test_numerics_know_no_equation(name):
    assert {base for base, _ in imported(SOLVERS / f"{name}.py")} <= {"core/newton"}


def test_every_second_method_of_boundary_values_is_the_cores():
    """Other collocation than that of surfaces without axial symmetry builds a Problem of the core."""
    for room in ("paper1/collocation/equations", "paper2/collocation/equations", "paper3/collocation",
                 "paper4/methods/collocation"):  # fmt: skip
        assert ("core/collocation", "Problem") in imported(SOLVERS / f"{room}.py")


def test_there_is_one_newton():
    """No other module of the reference side solves linear systems in a loop over corrections."""
    loops = set()
    for path in SOLVERS.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text("utf-8"))):
            if isinstance(node, ast.For) and "linalg.solve(" in ast.unparse(node):
                text = ast.unparse(node.iter)
                if (
                    text.startswith("range(")
                    and text != "range(k)"
                    and not any(isinstance(inner, ast.FunctionDef) for inner in ast.walk(node))
                ):
                    loops.add(path.relative_to(SOLVERS).as_posix())
    assert loops == {"core/newton.py"}


def test_methods_for_waves_around_parts_of_spheres_share_their_data_only():
    """Each takes one method of the limit points and one of the tube's waves."""
    taken = []
    for name in ("waves_shooting", "waves_ritz"):
        own = {module for module, _ in imported(SOLVERS / f"beyond/caps/{name}.py")}
        taken.append({module for module in own if not module.startswith("core/")})
    assert taken[0] & taken[1] == {"beyond/caps/ring"}
    assert [sorted(own - {"beyond/caps/ring"}) for own in taken] == [
        ["beyond/caps/shooting", "beyond/tube_waves/strong"],
        ["beyond/caps/energy", "beyond/tube_waves/ritz"],
    ]
