"""Tables without their solutions: what each of them asks for, while every answer of a solver is unknown.

A builder of a table decides what is computed (parameters, abscissae, tubes, names of columns) and lets other
functions compute it. Here those others answer :data:`UNKNOWN`, so that all tables are built in seconds. Which
function only asks, its annotation says: it returns a table, columns, texts or stored facts.
"""

from __future__ import annotations

import importlib
import inspect
import opcode
import re
import sys
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, is_dataclass, replace
from types import FunctionType, ModuleType
from typing import Any

import numpy as np

SOLVERS = "reference_data.solvers"
ASKS = re.compile(
    r"(list\[)?(Table|Column|Series|Builder|str|tuple\[str, \.\.\.\])\]?|tuple\[list\[Column\], .*"
    r"|dict\[str, (object|Builder|tuple\[float, float\]|tuple\[int \| str, Builder\])\]"
)
"""Answers of functions that solve nothing."""
DATA = {"body", "case", "disks", "every", "gas", "given", "law", "made", "material", "membrane", "other_of"}
DATA |= {"positions", "prescribed", "steps", "top", "tube", "u_end"}
"""Further functions that solve nothing."""
NAN = "nan"
"""What an unknown number is in a text."""
MOST = 20_000
"""Number of questions to unknown values after which a loop is taken to wait for an answer."""


class UnknownError(Exception):
    """What happens next depends on an answer."""


STOPS = (ArithmeticError, LookupError, RuntimeError, TypeError, ValueError, UnknownError)
"""What a function raises that needs an answer."""


class Unknown:
    """Any answer: a number that is not one, and an object that has every attribute."""

    asked = 0

    def _same(self, *_given: Any, **_named: Any) -> Unknown:
        return self

    def __getattr__(self, name: str) -> Unknown:
        if name.startswith("__"):
            raise AttributeError(name)
        return self

    def __iter__(self) -> Iterator[Unknown]:
        """As many as the caller takes apart; else two, one for each method or resolution."""
        frame = sys._getframe(1)
        code, at = frame.f_code.co_code, frame.f_lasti
        apart = opcode.opname[code[at]] == "UNPACK_SEQUENCE"
        return iter([self] * (code[at + 1] if apart else 2))

    def __bool__(self) -> bool:
        return True

    def _no(self, _other: object) -> bool:
        Unknown.asked += 1
        if Unknown.asked > MOST:
            raise UnknownError
        return False

    def __array_ufunc__(self, *_given: Any, **_named: Any) -> Unknown:
        return self

    __array_function__ = __array_ufunc__

    def __len__(self) -> int:
        return 2

    def __index__(self) -> int:
        return 0

    def __float__(self) -> float:
        return np.nan

    def __array__(self, dtype: Any = None, copy: Any = None) -> np.ndarray:
        return np.array(np.nan)

    def __format__(self, _how: str) -> str:
        return NAN

    __round__ = __call__ = __getitem__ = __neg__ = __abs__ = __add__ = __radd__ = __sub__ = __rsub__ = (
        __mul__
    ) = _same
    __rmul__ = __truediv__ = __rtruediv__ = __pow__ = __rpow__ = __matmul__ = __or__ = __ror__ = _same
    __lt__ = __le__ = __gt__ = __ge__ = _no


UNKNOWN = Unknown()


class Texts(dict):
    """Scalings and meanings of columns, also of unknown ones."""

    def __missing__(self, name: str) -> tuple[str, str]:
        if isinstance(name, Unknown):
            return NAN, NAN
        raise KeyError(name)


@dataclass
class Asked:
    """What a builder asked for.

    Attributes:
        builder: Module and function.
        folder: Of the committed table.
        table: The table with unknown columns, or None where it cannot be built without answers.
        chosen: Columns of values that are chosen, in the order in which they were made.
    """

    builder: str
    folder: str
    table: Any
    chosen: list[Any]


def requests() -> dict[str, Asked]:
    """What every table asks for, by name; modules in use are left alone."""
    with _another_copy():
        known = importlib.import_module(f"{SOLVERS}.registry").tables()
        chosen: list[Any] = []
        core = sys.modules[f"{SOLVERS}.core.tables"]
        put = _Substitutes(core, chosen).put
        for module in [m for name, m in sys.modules.items() if name.startswith(f"{SOLVERS}.")]:
            put(module)
        out = {}
        for name, (group, builder) in known.items():
            function = inspect.unwrap(getattr(builder, "func", builder))
            given, named = getattr(builder, "args", ()), getattr(builder, "keywords", {})
            Unknown.asked = 0
            chosen.clear()
            try:
                table = function(*given, **named)
            except STOPS:
                table = None
            table = None if isinstance(table, Unknown) else table
            label = f"{function.__module__.removeprefix(f'{SOLVERS}.')}.{_named(function)}"
            out[name] = Asked(label, core.folder_of(group), table, list(chosen))
    return out


def _named(function: FunctionType) -> str:
    """Name of a builder; of a lambda that calls one, the name of that one."""
    return function.__name__ if function.__name__ != "<lambda>" else function.__code__.co_names[0]


@contextmanager
def _another_copy() -> Iterator[None]:
    """Modules of the solvers imported inside are other ones than outside, so that they can be changed."""
    package = importlib.import_module("reference_data")
    before = {name: sys.modules.pop(name) for name in list(sys.modules) if name.startswith(SOLVERS)}
    kept = vars(package).get("solvers")
    try:
        yield
    finally:
        for name in [n for n in sys.modules if n.startswith(SOLVERS)]:
            del sys.modules[name]
        sys.modules.update(before)
        if kept is not None:
            package.solvers = kept


class _Substitutes:
    """What takes the place of values of modules; columns of chosen values are noted in ``chosen``."""

    def __init__(self, core: ModuleType, chosen: list[Any]) -> None:
        self._core, self._chosen, self._prescribed = core, chosen, core.prescribed

    def put(self, module: ModuleType) -> None:
        """Let all of a module that solves answer :data:`UNKNOWN`."""
        for key, value in list(vars(module).items()):
            inner = inspect.unwrap(value) if callable(value) else value
            if key == "COLUMNS" and isinstance(value, dict):
                setattr(module, key, Texts(value))
            elif value is replace:
                setattr(module, key, _replaced)
            elif str(getattr(inner, "__module__", "")).startswith(SOLVERS):
                if isinstance(inner, FunctionType):
                    setattr(module, key, self._function(inner))
                elif isinstance(inner, type) and not self._is_data(inner):
                    setattr(module, key, UNKNOWN)

    def _is_data(self, kind: type) -> bool:
        """Frozen data classes say what is asked for, the others hold states."""
        own = kind.__module__ == self._core.__name__ or issubclass(kind, tuple | Exception)
        return own or (is_dataclass(kind) and kind.__dataclass_params__.frozen)

    def _function(self, function: FunctionType) -> Any:
        answer, name = function.__annotations__.get("return", ""), function.__name__
        if function is self._prescribed:
            return self._noted
        if name in ("round_up", "last_digit"):
            return lambda _: np.nan
        if name in DATA:
            return function
        if answer == "Column":
            return self._column
        if answer.startswith("list[Column]"):
            return self._columns(function)
        asks = function.__module__ == self._core.__name__ or ASKS.fullmatch(answer)
        return function if asks else UNKNOWN  # without a cache, which would keep what is unknown

    def _noted(self, *given: Any) -> Any:
        self._chosen.append(self._prescribed(*given))
        return self._chosen[-1]

    def _column(self, _table: str, name: str, *more: Any, **_named: Any) -> Any:
        texts = (x for x in more if isinstance(x, tuple) and [type(t) for t in x] == [str, str])
        return self._core.Column(name, UNKNOWN, np.nan, *next(texts, (NAN, NAN)))

    def _columns(self, function: FunctionType) -> Callable:
        def tried(*given: Any, **named: Any) -> list[Any]:
            try:
                return function(*given, **named)
            except STOPS:
                return [*self._chosen, self._core.Column(UNKNOWN, UNKNOWN, np.nan, NAN, NAN)]

        return tried


def _replaced(old: Any, **new: Any) -> Any:
    return UNKNOWN if isinstance(old, Unknown) else replace(old, **new)


def same(asked: Any, committed: Any) -> bool:
    """Whether all that is known of what is asked for is as committed."""
    if isinstance(asked, Unknown):
        return True
    if isinstance(asked, np.ndarray | np.generic):
        asked = asked.tolist()
    if isinstance(asked, float) and np.isnan(asked):
        return True
    if isinstance(asked, str) and isinstance(committed, str):
        return re.fullmatch(".*".join(map(re.escape, asked.split(NAN))), committed, re.DOTALL) is not None
    if isinstance(asked, Mapping):
        return same(list(asked.items()), [list(item) for item in committed.items()])
    if isinstance(asked, list | tuple):
        return len(asked) == len(committed) and all(map(same, asked, committed))
    return isinstance(asked, bool) == isinstance(committed, bool) and asked == committed
