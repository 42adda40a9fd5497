"""No case decides by itself: statements about numbers are judged by ``weakforms.decide``."""

import ast
from pathlib import Path

import pytest

CASES = sorted((Path(__file__).resolve().parents[2] / "cases").rglob("*.py"))
AGREEMENT = {"agree", "zero", "constant", "not_negative"}
"""What takes the accuracy asked as an argument."""


def small(node: ast.AST, below: float) -> list[ast.Constant]:
    """Literal fractions in a part of the code."""
    found = [n for n in ast.walk(node) if isinstance(n, ast.Constant) and type(n.value) is float]
    return [n for n in found if 0 < n.value < below]


def called(node: ast.AST) -> str:
    """Name of the function of ``decide`` that is called, if it is one."""
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute):
        owner = node.func.value
        if isinstance(owner, ast.Name) and owner.id == "decide":
            return node.func.attr
    return ""


def faults(source: str) -> list[str]:
    """Where a case decides by itself, and how."""
    tree, found = ast.parse(source), []
    # An uncertainty may become another number's uncertainty, and nothing else.
    passed_on = {id(part) for node in ast.walk(tree) if called(node) == "Number" for part in ast.walk(node)}
    for node in ast.walk(tree):
        name = getattr(node, "attr", getattr(node, "id", ""))
        if name == "hypot" or (name == "uncertainty" and id(node) not in passed_on):
            found.append(f"line {node.lineno}: {name}")
        ordered = isinstance(node, ast.Compare) and not isinstance(node.ops[0], ast.Eq | ast.NotEq | ast.In)
        if ordered and small(node, 1.0):
            found.append(f"line {node.lineno}: a comparison with a literal fraction")
        if called(node) == "Stated" and not (
            len(node.args) == 3 and all(isinstance(a, ast.Constant | ast.JoinedStr) for a in node.args[1:])
        ):
            found.append(f"line {node.lineno}: a stated number without its word or its reason")
        if isinstance(node, ast.FunctionDef) and ast.unparse(node.returns or ast.Constant(0)) == "Finding":
            found += own_verdicts(node)
    return found


def own_verdicts(function: ast.FunctionDef) -> list[str]:
    """Findings that are not calls, and literal tolerances that do not request an accuracy."""
    asked = {
        id(argument)
        for node in ast.walk(function)
        if called(node) in AGREEMENT
        for argument in node.args
        if isinstance(argument, ast.Constant)
    }
    out = [
        f"line {node.lineno}: returns something other than a decision"
        for node in ast.walk(function)
        if isinstance(node, ast.Return) and not isinstance(node.value, ast.Call)
    ]
    return out + [
        f"line {node.lineno}: the literal tolerance {node.value}"
        for node in small(function, 1.1e-3)
        if id(node) not in asked
    ]


@pytest.mark.parametrize("path", CASES, ids=lambda path: f"{path.parent.name}.{path.stem}")
def test_a_case_decides_nothing_by_itself(path):
    assert not faults(path.read_text("utf-8"))


@pytest.mark.parametrize(
    "body",
    [
        "return x.value < 1e-6, 'found'",
        "return decide.same('x', x < 0.05, True)",
        "return decide.every('x', [error <= 2 * np.hypot(a, b)])",
        "return decide.every('x', [error <= 2 * u + 1e-10])",
        "return decide.every('x', [error <= 2 * x.uncertainty])",
        "limit = 1e-6\n    return decide.every('x', [error < limit])",
        "return decide.at_most('x', x, decide.Stated(0.1, 'small'))",
        "return bool(x), 'found'",
    ],
)
def test_the_rule_notices(body):
    assert faults(f"def claim(solutions) -> Finding:\n    {body}\n")


def test_the_rule_lets_accuracies_asked_and_stated_sizes_pass():
    body = "return decide.all_of(decide.agree('x', a, b, 1e-6), decide.at_most('y', c, SMALL))"
    stated = "SMALL = decide.Stated(1e-3, 'small', 'why')\n"
    assert not faults(f"{stated}def claim(solutions) -> Finding:\n    {body}\n")
