"""The types of ``solve`` by problem, for editors: ``python3 -m weakforms.docs.stubs`` writes them."""

from __future__ import annotations

import ast
import types
import typing
from collections.abc import Iterator
from pathlib import Path

from weakforms import api

SOURCE = Path(api.__file__)
STUBS = SOURCE.with_suffix(".pyi")
PLAIN = (bool, int, float, str)


def stubs() -> str:
    """The text of ``api.pyi``: an overload of ``solve`` for each problem, and the other names as they are."""
    tree = ast.parse(SOURCE.read_text("utf-8"))
    parts = [
        '"""Written by ``python3 -m weakforms.docs.stubs``; a test compares it with the problems."""',
        "",
    ]
    solve = next(n for n in tree.body if isinstance(n, ast.FunctionDef) and n.name == "solve")
    imports = [n for n in tree.body if isinstance(n, ast.Import | ast.ImportFrom)]
    parts += [ast.unparse(n) for n in imports if ast.unparse(n) != "import warnings"]
    parts += ["from typing import overload", ""]
    for node in tree.body:
        if isinstance(node, ast.Assign):
            parts += [ast.unparse(node), ""]
        if isinstance(node, ast.FunctionDef) and node.name != "solve":
            parts += [_stub(node), ""]
    for name, problem in api.require_environment().problems().items():
        own = "".join(f", {n}: {t} = ..." for n, t in _parameters(problem.parameters))
        parts += [
            "@overload",
            f'def solve(problem: Literal["{name}"], *, {_shared(solve)}{own}) -> Result: ...',
        ]
    parts += ["@overload", _stub(solve), ""]
    return "\n".join(parts)


def _stub(node: ast.FunctionDef) -> str:
    returns = ast.unparse(node.returns) if node.returns else None
    return f"def {node.name}({ast.unparse(node.args)}) -> {returns}: ..."


def _shared(solve: ast.FunctionDef) -> str:
    """The keywords of ``solve`` that every problem has."""
    pairs = zip(solve.args.kwonlyargs, solve.args.kw_defaults, strict=True)
    return ", ".join(f"{a.arg}: {ast.unparse(a.annotation)} = {ast.unparse(d)}" for a, d in pairs)  # type: ignore[arg-type]


def _parameters(of: typing.Any) -> Iterator[tuple[str, str]]:
    """Names and types of a problem's parameters, and of the constants of all laws if it chooses one."""
    for name, field in of.model_fields.items():
        if name != "constants":
            yield name, _type(field.annotation)
    if hasattr(of, "further"):
        yield from ((name, "float") for name in sorted(of.further() - set(of.model_fields)))


def _type(annotation: typing.Any) -> str:
    """A type as text; what is neither plain nor a choice is any."""
    origin = typing.get_origin(annotation)
    if origin is typing.Annotated:
        return _type(typing.get_args(annotation)[0])
    if origin is typing.Literal:
        return f"Literal[{', '.join(map(repr, typing.get_args(annotation)))}]"
    if origin in (typing.Union, types.UnionType):
        found = list(dict.fromkeys(map(_type, typing.get_args(annotation))))
        return "Any" if "Any" in found else " | ".join(found)
    if annotation is type(None):
        return "None"
    return annotation.__name__ if annotation in PLAIN else "Any"


if __name__ == "__main__":
    STUBS.write_text(stubs(), encoding="utf-8")
