"""Uncertainties that are constants, and tables with one method only: docs/reference-methods.md."""

import ast
import importlib
import pkgutil
import re
import tomllib
from pathlib import Path

import numpy as np
import pytest

from reference_data import solvers

ROOT = Path(__file__).resolve().parents[3]
PAGE = ROOT / "docs" / "reference-methods.md"
FOLDERS = ("reference_data/solvers", "weakforms/problems", "weakforms/solvers")
SMALL = 1e-3  # larger numbers are factors, not errors
MAKERS = {
    *("Column", "Estimate", "Levels", "Pair", "Quantity", "Slow"),
    *("_on_all", "columns_of", "refined", "round_up", "rounded", "shifted"),
}
"""Functions that take an uncertainty or return one."""
NAMES = re.compile(r"floor|uncertain|^left$|^loose$|^rest$|rounding")
"""Names of variables, arguments and columns that hold an uncertainty."""


def small(node: ast.AST) -> list[ast.Constant]:
    """Numbers in an expression that are as small as errors, except those in comparisons."""
    compared = {id(m) for n in ast.walk(node) if isinstance(n, ast.Compare) for m in ast.walk(n)}
    return [
        n
        for n in ast.walk(node)
        if isinstance(n, ast.Constant) and isinstance(n.value, float) and 0 < abs(n.value) <= SMALL
        if id(n) not in compared
    ]


def named(target: ast.AST) -> bool:
    """Whether the name of an assignment's target says that it holds an uncertainty."""
    texts = [n.id for n in ast.walk(target) if isinstance(n, ast.Name)]
    texts += [n.attr for n in ast.walk(target) if isinstance(n, ast.Attribute)]
    return any(NAMES.search(t) for t in texts)


def expressions(tree: ast.Module) -> list[ast.AST]:
    """Expressions whose value becomes an uncertainty."""
    out: list[ast.AST] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = getattr(node.func, "id", getattr(node.func, "attr", ""))
            if name == "Field":  # of results: name, columns, uncertainties; pydantic's has no third place
                out += node.args[2:]
            elif name in MAKERS:
                out += node.args + [k.value for k in node.keywords]
            out += [k.value for k in node.keywords if k.arg and NAMES.search(k.arg)]
        elif isinstance(node, ast.Assign | ast.AnnAssign | ast.AugAssign) and node.value:
            targets = getattr(node, "targets", None) or [node.target]
            out += [node.value] * any(named(t) for t in targets if not isinstance(t, ast.Tuple))
        elif isinstance(node, ast.For | ast.comprehension) and named(node.target):
            out.append(node.iter)
        elif isinstance(node, ast.FunctionDef):
            given = node.args.args[len(node.args.args) - len(node.args.defaults) :]
            pairs = zip(given, node.args.defaults, strict=True)
            out += [d for a, d in pairs if NAMES.search(a.arg)]
            if NAMES.search(node.name):
                out += [n.value for n in ast.walk(node) if isinstance(n, ast.Return) and n.value]
    return out


def constants(tree: ast.Module) -> dict[str, list[float]]:
    """Constants of a module, with names in capitals, that are as small as errors."""
    out = {}
    for node in tree.body:
        if isinstance(node, ast.Assign) and (found := small(node.value)):
            for name in (n.id for t in node.targets for n in ast.walk(t) if isinstance(n, ast.Name)):
                if name.isupper():
                    out[name] = [n.value for n in found]
    return out


def found_in(text: str, modules: dict[str, set[str]]) -> set[str]:
    """Names and literal numbers that become uncertainties; ``modules`` are the others' constants."""
    tree = ast.parse(text)
    own, aliases, kept = set(constants(tree)), {}, {}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            own |= modules.get(node.module or "", set()) & {a.name for a in node.names}
            aliases |= {a.asname or a.name: f"{node.module}.{a.name}" for a in node.names}
    for node in tree.body:
        for name in constants(ast.Module([node], [])):
            kept |= {id(n): name for n in ast.walk(node)}
    out = set()
    for expression in expressions(tree):
        out |= {kept.get(id(n), f"{n.value:g}") for n in small(expression)}
        for node in ast.walk(expression):
            if isinstance(node, ast.Name) and node.id in own:
                out.add(node.id)
            elif isinstance(node, ast.Attribute):
                owner = aliases.get(getattr(node.value, "id", ""), "")
                out |= {node.attr} & modules.get(owner, set())
    return out


def all_found() -> dict[tuple[str, str], str]:
    """(file, name or number) of every constant that becomes an uncertainty."""
    paths = sorted(p for folder in FOLDERS for p in (ROOT / folder).rglob("*.py"))
    texts = {p: p.read_text() for p in paths}
    dotted = {p: ".".join(p.relative_to(ROOT).with_suffix("").parts) for p in paths}
    modules = {dotted[p]: set(constants(ast.parse(text))) for p, text in texts.items()}
    return {
        (re.sub(r"^(reference_data/solvers|weakforms)/", "", p.relative_to(ROOT).as_posix()), name): str(p)
        for p, text in texts.items()
        for name in found_in(text, modules)
    }


def listed() -> set[tuple[str, str]]:
    """(file, name or number) of every row of the page's table; files relative to their side."""
    text = PAGE.read_text()
    rows = re.findall(r"^\| `([a-z0-9_/]+\.py)` \| ([^|]+) \|", text, re.MULTILINE)
    named = [(stem, name) for stem, names in rows for name in re.findall(r"`([^`]+)`", names)]
    return {(stem, f"{float(name):g}" if name[0].isdigit() else name) for stem, name in named}


def ratios() -> dict[str, float]:
    """Largest difference of two methods divided by both uncertainties, by module of tables."""
    modules = {}
    for info in pkgutil.walk_packages(solvers.__path__, f"{solvers.__name__}."):
        if info.name.rpartition(".")[2].startswith("tables") and ".core." not in info.name:
            module = importlib.import_module(info.name)
            # A table may be offered again by a module further up: it belongs to the one found first.
            modules = dict.fromkeys(module.TABLES, "/".join(info.name.split(".")[2:])) | modules
    out: dict[str, float] = {}
    for path in (ROOT / "reference_data").glob("*/*.toml"):
        for column in tomllib.loads(path.read_text())["columns"].values():
            allowed = [v for k, v in column.items() if k.startswith("uncertainty_")]
            if len(allowed) == 2:
                ratio = column["largest_difference_of_methods"] / np.hypot(*allowed)
                out[modules[path.stem]] = max(out.get(modules[path.stem], 0.0), ratio)
    return out


def test_every_constant_that_is_an_uncertainty_is_listed():
    found, rows = all_found(), listed()
    missing = sorted(f"{found[key]}: {key[1]}" for key in found.keys() - rows)
    assert not missing, f"not in the table of {PAGE.name}: {missing}"
    gone = sorted(rows - found.keys())
    assert not gone, f"in the table of {PAGE.name} but no longer in the code: {gone}"


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("LEFT = 3e-9\ndef f(x):\n    return Estimate(x, LEFT)", {"LEFT"}),
        ("c = Column('a', x, gap + 2e-7)", {"2e-07"}),
        ("def f(floor=1e-9): ...", {"1e-09"}),
        ("left = 1e-10 * x", {"1e-10"}),
        ("q = Quantity(v, 1e-13)", {"1e-13"}),
        ("S = Slow(size=6e-9, order=2.0)", {"S"}),
        ("if size < 1e-9: pass", set()),
        ("left = x <= 1.0 + 1e-12", set()),
        ("x = brentq(f, 0, 1, xtol=1e-14)", set()),
    ],
)
def test_constants_are_found_where_they_end_in_an_uncertainty(text, expected):
    assert found_in(text, {}) == expected


def test_two_methods_differ_by_less_than_constants_and_refinement_allow():
    """The page describes each group of tables as the tables are."""
    measured, rows = ratios(), re.findall(r"two methods, tables of ([^:|]+): ([0-9.]+)", PAGE.read_text())
    assert len(rows) > 10
    for names, said in rows:
        worst = max(measured[name] for name in re.findall(r"`([^`]+)`", names))
        assert worst < 1
        assert worst <= float(said) < worst + 0.02, f"{names}: {worst:.3f}, not {said}"


def test_tables_of_one_method_are_listed():
    one = set()
    for path in (ROOT / "reference_data").glob("*/*.toml"):
        columns = tomllib.loads(path.read_text())["columns"].values()
        if not any("largest_difference_of_methods" in c for c in columns):
            one.add(path.stem)
    text = PAGE.read_text()
    first = text[: text.index("## The bent states")]
    rows = re.findall(r"^\| (`[^|]+) \|", first, re.MULTILINE)
    assert {name for row in rows for name in re.findall(r"`([^`]+)`", row)} == one
