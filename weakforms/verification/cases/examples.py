"""Examples of problems for ``weakforms show`` and the documentation: weak form, code, command, picture."""

from __future__ import annotations

import importlib
import inspect
import textwrap
from typing import Any

from weakforms.problems.about import About
from weakforms.verification.cases.specs import Spec

WEAK_FORM = (
    "find u = {unknown} such that dPi(u + e v)/de = 0 at e = 0 for every admissible v; the tangent is the "
    "second variation, both by ufl.derivative"
)


def specs(about: About) -> list[Spec]:
    """Solutions for the picture of the example; none without an example."""
    if about.example is None:
        return []
    given = about.example
    rows = [{given.x: value} for value in given.values] or [{}]
    numerics = tuple(sorted(given.numerics.items()))
    return [Spec(about.name, tuple(sorted({**given.parameters, **row}.items())), numerics) for row in rows]


def weak_form(about: About) -> str:
    """The weak form in words."""
    return WEAK_FORM.format(unknown=about.unknown)


def code(about: About) -> list[str]:
    """Three lines of Python that solve the problem and print a result."""
    given = about.example
    words = "".join(f", {name}={value!r}" for name, value in given.parameters.items()) if given else ""
    last = "print(result.branches, result.quantities)"
    if given:
        branch = 'result.branch("primary")' if "primary" in about.branches else "result.branches[0]"
        columns = f'{branch}.columns["{given.x}"], {branch}.columns["{given.y}"]'
        last = f'print(result.quantities["{given.y}"])' if given.values else f"print({columns})"
    return ["import weakforms", f'result = weakforms.solve("{about.name}"{words})', last]


def command(about: About) -> str:
    """The example as a shell command."""
    given = about.example.parameters if about.example else {}
    sets = "".join(f" --set {name}={value}" for name, value in given.items())
    return f"./run solve {about.name}{sets} --out {about.name}.json"


def written_forms(about: About) -> list[tuple[str, Any, str]]:
    """The functions that define a problem's functional: name, function or module, and source.

    For a module (``module:``) there is no source, only its docstring.
    """
    out = []
    for place in about.forms:
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
