"""Every public name of the package with its signature and docstring."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from types import ModuleType
from typing import Any

from weakforms.docs.prose import docstring

GROUPS = {
    "weakforms": "What is imported from `weakforms`",
    "weakforms.cases": "What case files need",
    "weakforms.forms": "Energies",
    "weakforms.problems": "Physical problems",
    "weakforms.solvers": "Solvers",
    "weakforms.results": "Results",
    "weakforms.verification": "Verification",
}
"""Pages of the API: the package itself, then its subpackages in the order in which they may import."""


def modules(group: str) -> list[dict[str, Any]]:
    """The modules of a group: name, text, members."""
    package = importlib.import_module(group)
    if group in ("weakforms", "weakforms.cases"):
        return [_public(package)]
    found = [package]
    for info in sorted(pkgutil.walk_packages(package.__path__, f"{group}."), key=lambda item: item.name):
        if not info.name.rpartition(".")[2].startswith("_"):
            found.append(importlib.import_module(info.name))
    return [_described(module) for module in found]


def _public(package: ModuleType) -> dict[str, Any]:
    """The package's own names, wherever they are defined."""
    names = [name for name in package.__all__ if not inspect.ismodule(getattr(package, name))]
    members = [_member(name, getattr(package, name)) for name in names]
    return {
        "name": package.__name__,
        "text": docstring(package.__doc__),
        "members": [m for m in members if m],
    }


def _described(module: ModuleType) -> dict[str, Any]:
    members = [
        _member(name, value)
        for name, value in vars(module).items()
        if not name.startswith("_") and getattr(value, "__module__", None) == module.__name__
    ]
    return {"name": module.__name__, "text": docstring(module.__doc__), "members": [m for m in members if m]}


def _member(name: str, value: Any) -> dict[str, Any] | None:
    if inspect.isclass(value):
        methods = [
            {"name": key, "signature": _signature(item), "text": docstring(inspect.getdoc(item))}
            for key, item in vars(value).items()
            if not key.startswith("_") and (inspect.isfunction(item) or isinstance(item, property))
        ]
        return _entry("class", name, value, methods)
    if inspect.isfunction(value):
        return _entry("function", name, value, [])
    return None


def _entry(kind: str, name: str, value: Any, methods: list[dict[str, Any]]) -> dict[str, Any]:
    text = docstring(inspect.getdoc(value))
    return {"kind": kind, "name": name, "signature": _signature(value), "text": text, "methods": methods}


def _signature(value: Any) -> str:
    """The signature as written in the source; empty where there is none."""
    try:
        written = "" if isinstance(value, property) else str(inspect.signature(value))
        return re.sub(r"(: |-> )'([^']*)'", r"\1\2", written)
    except (ValueError, TypeError):
        return ""
