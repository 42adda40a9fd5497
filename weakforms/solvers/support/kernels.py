r"""Faster element matrices: BLAS adds up what ffcx would add up in loops.

A tangent has many products for each entry of the element matrix: one for each pair of derivatives of test
and trial functions. At each quadrature point ``q``, ffcx adds each product to the matrix by itself,

.. code-block:: text

    for q: for j: for i: A[i, j] += dphi_x[q, i] * (f1 * dphi_x[q, j]);  A[i, j] += dphi_x[q, i] * (f2 * ...

The element matrix of a surface of high degree is too large for the fastest memory, through which it passes at
each point. Here products with the same factor in ``i`` are summed and kept for all points. After this loop,
BLAS multiplies them with the table of that factor:

.. code-block:: text

    for q: for j: s[q, j] = f1 * dphi_x[q, j] + f2 * dphi_y[q, j] + ...
    A += transpose(dphi_x) * s + ...

The sums are the same up to their order. On quadrilaterals with three components, a tangent of sixth degree
and one of third degree take a fifth of the time.
"""

from __future__ import annotations

import functools
from collections import defaultdict
from collections.abc import Callable
from math import prod
from typing import Any

from ffcx.codegeneration import integral_generator, lnodes, optimizer

from weakforms.solvers.support.products import ADD_PRODUCT

MARK = "-DWEAKFORMS_MULTIPLIED"
"""An argument of the C compiler without effect, which keeps modules of this generator apart in the cache."""

LARGEST = 2**22
"""Bytes that all sums of an element may take on the stack; where more are needed, ffcx's loops stay."""

POINT = lnodes.Symbol("iq", lnodes.DataType.INT)
"""The variable of ffcx's loop over quadrature points."""

UNLIKE = (AssertionError, AttributeError, LookupError, NotImplementedError, TypeError, ValueError)
"""What the code of another ffcx raises, whose loops look different: they stay as they are."""

Products = dict[lnodes.ArrayAccess, dict[tuple[lnodes.LExpr, ...], list[lnodes.LExpr]]]
"""For each entry of the element matrix: the other factors of its products, by their factors in the row."""

_loops: list[tuple[list[lnodes.ArrayDecl], list[lnodes.VariableDecl]]] = []
"""Of the quadrature loop whose code is being generated: arrays of sums, and their products, which follow the
loop. Outside of a loop there is no place for products, and ffcx's own treatment remains."""


def install() -> None:
    """Make ffcx write its element matrices this way, if it has such loops; repeated calls have no effect."""
    usual, generator = getattr(optimizer, "licm", None), integral_generator.IntegralGenerator
    if usual is not None and not getattr(usual, "multiplies", False):
        generator.generate_quadrature_loop = _with_products(generator.generate_quadrature_loop)
        optimizer.licm = _multiplying(usual)


def _with_products(usual: Callable) -> Callable:
    """Wrap the generation of a quadrature loop: arrays of sums come before it, their products after it."""

    @functools.wraps(usual)
    def generated(*args: Any) -> list[lnodes.LNode]:
        _loops.append(([], []))
        try:
            loop = usual(*args)
        finally:
            sums, products = _loops.pop()
        return [*sums, *loop, *products]

    return generated


def _multiplying(usual: Callable) -> Callable:
    """Wrap ffcx's treatment of a loop over the entries of a matrix."""

    @functools.wraps(usual)
    def multiplying(section: lnodes.Section, rule: Any) -> lnodes.Section:
        try:
            rows, columns, products = _gathered(section)
            section.statements = [_multiplied(rows, columns, products, rule)]
        except UNLIKE:
            return usual(section, rule)
        return section

    multiplying.multiplies = True
    return multiplying


def _gathered(section: lnodes.Section) -> tuple[lnodes.ForRange, lnodes.ForRange, Products]:
    """Loops over rows and columns, and the products that they add up.

    Raises:
        ValueError: If the code is of another kind.
    """
    (columns,) = section.statements
    (rows,) = columns.body.statements
    products: Products = defaultdict(lambda: defaultdict(list))
    for statement in rows.body.statements:
        for added in optimizer.get_statements(statement):
            if not (isinstance(added, lnodes.AssignAdd) and isinstance(added.rhs, lnodes.Product)):
                raise ValueError("something else than a product is added")
            factors = added.rhs.args
            in_row = [optimizer.check_dependency(factor, rows.index) for factor in factors]
            own = tuple(factor for factor, depends in zip(factors, in_row, strict=True) if depends)
            rest = [factor for factor, depends in zip(factors, in_row, strict=True) if not depends]
            products[added.lhs][own].append(lnodes.Product(rest))
    return rows, columns, products


def _multiplied(
    rows: lnodes.ForRange, columns: lnodes.ForRange, products: Products, rule: Any
) -> lnodes.ForRange:
    """The loop that keeps the sums of a quadrature point; BLAS multiplies them after all points.

    The entries of all rows that belong to one scalar basis function lie side by side in memory, so that one
    product with a table serves all pairs of components.

    Raises:
        ValueError: If the products are not of that kind, or need too much memory.
    """
    places = {entry: _place(entry.indices[0], rows.index, columns.index) for entry in products}
    ((stride, step),) = {(stride, step) for stride, step, _ in places.values()}
    offsets = [offset for _, _, offset in places.values()]
    first, height, width, points = min(offsets), rows.end.value, columns.end.value, len(rule.weights)
    across = max(offsets) - first + step * (width - 1) + 1
    tables = dict.fromkeys(own for by_row in products.values() for own in by_row)
    if across > stride or 8 * len(tables) * points * across > LARGEST:
        raise ValueError("rows overlap, or the sums need too much memory")
    starts = {own: _start(own, rows.index) for own in tables}
    sums, added = _loops[-1]
    kept = []
    for own, start in starts.items():
        name = lnodes.Symbol(f"sums_{rule.id()}_{len(sums)}", lnodes.DataType.SCALAR)
        parts = {
            offset: products[entry][own] for entry, (*_, offset) in places.items() if own in products[entry]
        }
        has_gaps = len(parts) * width < across
        sums.append(lnodes.ArrayDecl(name, (points, across), [0] if has_gaps else None))
        for offset, summed in parts.items():
            place = lnodes.ArrayAccess(name, [POINT, step * columns.index + (offset - first)])
            kept.append(lnodes.Assign(place, lnodes.Sum(summed)))
        numbers = first, stride, height, across, points
        pointers = start, lnodes.ArrayAccess(name, [0])
        element = next(iter(products)).array
        done = lnodes.Symbol(f"added_{rule.id()}_{len(added)}", lnodes.DataType.INT)
        call = lnodes.MathFunction(ADD_PRODUCT, [element, *numbers, *pointers])
        added.append(lnodes.VariableDecl(done, call))
    return lnodes.ForRange(columns.index, columns.begin, columns.end, kept)


def _start(factors: tuple[lnodes.LExpr, ...], row: lnodes.Symbol) -> lnodes.ArrayAccess:
    """First entry of a table with a value for each quadrature point and row.

    Raises:
        ValueError: If the factors are something else.
    """
    (table,) = factors
    permutation, entity, point, function = table.indices
    if [point.args, function.args] != [[POINT], [row]]:
        raise ValueError("the table does not have a value for each point and row")
    return lnodes.ArrayAccess(table.array, [permutation, entity, 0])


def _place(index: lnodes.LExpr, row: lnodes.Symbol, column: lnodes.Symbol) -> tuple[int, int, int]:
    """Steps ``a``, ``b`` and start ``c`` of a place in memory, ``a i + b j + c``."""
    start, below, beside = (_number(index, {row: i, column: j}) for i, j in ((0, 0), (1, 0), (0, 1)))
    return below - start, beside - start, start


def _number(index: lnodes.LExpr, values: dict[lnodes.Symbol, int]) -> int:
    """Value of an index at values of its variables.

    Raises:
        TypeError: If there is anything else in it than sums and products.
    """
    if isinstance(index, lnodes.MultiIndex):
        index = index.global_index
    match index:
        case lnodes.LiteralInt():
            return index.value
        case lnodes.Symbol():
            return values[index]
        case lnodes.Sum() | lnodes.Product():
            parts = index.args
        case lnodes.Add() | lnodes.Mul():
            parts = [index.lhs, index.rhs]
        case _:
            raise TypeError(f"an index contains {index}")
    numbers = [_number(part, values) for part in parts]
    return sum(numbers) if isinstance(index, lnodes.Sum | lnodes.Add) else prod(numbers)
