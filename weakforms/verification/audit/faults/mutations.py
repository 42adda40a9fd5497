"""Small changes of Python source that nobody chose: every one that the rules below allow in a file.

They are made on the text, at the places that the syntax tree names, so that a change is a few characters of
the line as it stands. The usual libraries (cosmic-ray, mutmut) have no dropped terms, no constants changed by
one per cent and no swapped branches, and Debian has none of them; the standard library's ``ast`` is enough.
"""

from __future__ import annotations

import ast
import re
from bisect import bisect
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import accumulate

ARITHMETIC = {
    ast.Add: ("+", "-"),
    ast.Sub: ("-", "+"),
    ast.Mult: ("*", "/"),
    ast.Div: ("/", "*"),
    ast.Pow: ("**", "*"),
    ast.FloorDiv: ("//", "/"),
    ast.Mod: ("%", "*"),
}
COMPARISON = {
    ast.Lt: ("<", ("<=", ">")),
    ast.LtE: ("<=", ("<", ">")),
    ast.Gt: (">", (">=", "<")),
    ast.GtE: (">=", (">", "<")),
    ast.Eq: ("==", ("!=",)),
    ast.NotEq: ("!=", ("==",)),
    ast.Is: ("is", ("is not",)),
    ast.IsNot: ("is not", ("is",)),
    ast.In: ("in", ("not in",)),
    ast.NotIn: ("not in", ("in",)),
}
"""An operator as it is written, and what takes its place."""

_AFTER_OPERAND = r"[\s)\\]*(?:#[^\n]*\n[\s)\\]*)*"
"""What may stand between an operand and the operator: closing brackets, white space, comments."""


@dataclass(frozen=True)
class Mutation:
    """One change of a file's text: characters ``start`` to ``end`` replaced."""

    kind: str
    """One of arithmetic, comparison, logic, constant, term, argument, statement, branch."""
    start: int
    end: int
    replace: str
    line: int
    """The line that the change begins in, from 1."""

    def applied(self, text: str) -> str:
        """The file's text with the change."""
        return text[: self.start] + self.replace + text[self.end :]

    def is_sound(self, text: str) -> bool:
        """Whether the changed text is Python, and another program."""
        try:
            return ast.dump(ast.parse(self.applied(text))) != ast.dump(ast.parse(text))
        except SyntaxError:
            return False


def mutations(text: str) -> list[Mutation]:
    """Every change of a source file, in the order of the text; a few are not :meth:`~Mutation.is_sound`.

    Left alone are texts and messages, annotations (and what is imported for them only), decorators, imports
    and asserts: what they say is not what the program computes. So is ``strict=True``: it only refuses.

    Raises:
        SyntaxError: When the text is no Python.
    """
    source = _Source(text)
    found = {change for node in _nodes(ast.parse(text)) for change in source.of(node)}
    return sorted(found, key=lambda m: (m.start, m.end, m.replace))


def _nodes(node: ast.AST, operand: bool = False) -> Iterator[ast.AST]:
    """Nodes that may change; a number knows whether it stands in arithmetic."""
    skipped = {"annotation", "returns", "decorator_list", "type_comment", "names", "msg"}
    if isinstance(node, ast.JoinedStr | ast.Assert | ast.Raise):
        return
    if isinstance(node, ast.keyword) and node.arg == "strict":
        return
    if isinstance(node, ast.If) and isinstance(node.test, ast.Name) and node.test.id == "TYPE_CHECKING":
        return
    node.in_arithmetic = operand
    yield node
    for name, value in ast.iter_fields(node):
        if name in skipped:
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                inner = isinstance(node, ast.BinOp) or (isinstance(node, ast.UnaryOp) and operand)
                yield from _nodes(child, inner)


class _Source:
    """Text with the places of its nodes; the tree counts bytes in a line, the text characters."""

    def __init__(self, text: str) -> None:
        self.text = text
        self._lines = text.split("\n")
        self._begins = list(accumulate((len(line) + 1 for line in self._lines), initial=0))

    def _at(self, line: int, column: int) -> int:
        return self._begins[line - 1] + len(self._lines[line - 1].encode()[:column].decode())

    def start(self, node: ast.AST) -> int:
        return self._at(node.lineno, node.col_offset)

    def end(self, node: ast.AST) -> int:
        return self._at(node.end_lineno, node.end_col_offset)

    def of(self, node: ast.AST) -> Iterator[Mutation]:
        """Changes of one node itself."""
        rule = getattr(self, f"_{type(node).__name__.lower()}", None)
        if rule is not None:
            yield from rule(node)

    def _change(self, kind: str, start: int, end: int, replace: str) -> Mutation:
        return Mutation(kind, start, end, replace, bisect(self._begins, start))

    def _operator(self, left: ast.AST, right: ast.AST, written: str) -> tuple[int, int] | None:
        begin = self.end(left)
        pattern = r"\s+".join(map(re.escape, written.split()))
        match = re.match(f"{_AFTER_OPERAND}({pattern})", self.text[begin : self.start(right)])
        return (begin + match.start(1), begin + match.end(1)) if match else None

    def _binop(self, node: ast.BinOp) -> Iterator[Mutation]:
        written, other = ARITHMETIC.get(type(node.op), ("", ""))
        place = self._operator(node.left, node.right, written) if written else None
        texts = any(isinstance(side, ast.JoinedStr) or _is_text(side) for side in (node.left, node.right))
        if place is None or texts:
            return
        yield self._change("arithmetic", *place, other)
        if isinstance(node.op, ast.Add | ast.Sub):
            yield self._change("term", place[0], self.end(node), "")
            if not (isinstance(node.left, ast.BinOp) and isinstance(node.left.op, ast.Add | ast.Sub)):
                kept = place[0] if isinstance(node.op, ast.Sub) else place[1]
                kept += len(self.text[kept:]) - len(self.text[kept:].lstrip(" "))
                yield self._change("term", self.start(node), kept, "")

    def _unaryop(self, node: ast.UnaryOp) -> Iterator[Mutation]:
        if isinstance(node.op, ast.USub | ast.Not):
            kind, written = ("logic", "not ") if isinstance(node.op, ast.Not) else ("arithmetic", "-")
            yield self._change(kind, self.start(node), self.start(node) + len(written), "")

    def _compare(self, node: ast.Compare) -> Iterator[Mutation]:
        sides = [node.left, *node.comparators]
        for left, operator, right in zip(sides, node.ops, node.comparators, strict=False):
            written, others = COMPARISON[type(operator)]
            place = self._operator(left, right, written)
            if place is not None:
                yield from (self._change("comparison", *place, other) for other in others)

    def _boolop(self, node: ast.BoolOp) -> Iterator[Mutation]:
        written, other = ("and", "or") if isinstance(node.op, ast.And) else ("or", "and")
        for left, right in zip(node.values, node.values[1:], strict=False):
            place = self._operator(left, right, written)
            if place is not None:
                yield self._change("logic", *place, other)

    def _constant(self, node: ast.Constant) -> Iterator[Mutation]:
        value = node.value
        if isinstance(value, bool):
            other: object = not value
        elif isinstance(value, float):
            other = _changed(value)
        elif isinstance(value, int):  # a count or a place cannot change by one per cent
            other = _changed(value) if node.in_arithmetic and value else value + 1
        else:
            return
        yield self._change("constant", self.start(node), self.end(node), repr(other))

    def _call(self, node: ast.Call) -> Iterator[Mutation]:
        """Named arguments only, and not what only refuses: without one of the others no call succeeds."""
        given = sorted([*node.args, *node.keywords], key=self.start)
        for k, argument in enumerate(given):
            if isinstance(argument, ast.keyword) and argument.arg not in (None, "strict"):
                start = self.end(given[k - 1]) if k else self.start(argument)
                end = self.start(given[k + 1]) if k == 0 and len(given) > 1 else self.end(argument)
                yield self._change("argument", start, end, "")

    def _expr(self, node: ast.Expr) -> Iterator[Mutation]:
        if isinstance(node.value, ast.Call):
            yield self._change("statement", self.start(node), self.end(node), "pass")

    def _if(self, node: ast.If | ast.IfExp) -> Iterator[Mutation]:
        """The branches change places; what has one only is done where it was not."""
        start, end = self.start(node.test), self.end(node.test)
        yield self._change("branch", start, end, f"not ({self.text[start:end]})")

    _ifexp = _while = _if


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _changed(value: float) -> float:
    """One per cent more, in a few digits."""
    return float(f"{1.01 * value:.15g}") if value else 0.01
