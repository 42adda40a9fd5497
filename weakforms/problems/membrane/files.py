"""A user's mesh as the stress-free surface of a membrane, and what is refused in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import lru_cache
from itertools import combinations
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn

import numpy as np

from weakforms.errors import InputError, not_among
from weakforms.problems.membrane.planes import Surface, keys, rigid_motions
from weakforms.problems.membrane.reference import AXES, PLANE, Reference, quadratics
from weakforms.problems.triangles.checks import at, edges_of, require_manifold
from weakforms.problems.triangles.files import compact, read_mesh

if TYPE_CHECKING:
    import meshio

EXTENT = 0.1, 10.0
"""Allowed half of the largest extent over the unit of length."""

ORDER = [0, 1, 2, 4, 5, 3]
"""Nodes of a curved triangle of a file in the order of :class:`Reference`."""

NODES = np.array([(0, 0), (1, 0), (0, 1), (0.5, 0.5), (0, 0.5), (0.5, 0)])
"""Places of the nodes of a curved triangle."""


KINDS = "held", "mirror", "slide"
"""Parameters that name groups of edges."""


class Refusal:
    """Raises errors about one file."""

    def __init__(self, path: str) -> None:
        self.named = f"membrane: mesh = {path}"

    def __call__(self, what: str) -> NoReturn:
        """Raise the error."""
        raise InputError(f"{self.named}: {what}")


def from_file(
    path: str,
    unit: float,
    held: Sequence[str],
    mirrors: Sequence[str],
    slides: Sequence[str] = (),
    moved: Sequence[str] = (),
) -> Reference:
    """The surface in a file; read again only if the file has changed.

    Args:
        path: A file that meshio reads, with straight or quadratic triangles.
        unit: Length in the units of the file by which all lengths are divided.
        held: Names of groups of edges that are held; without any, every edge that is on no mirror and does
            not slide.
        mirrors: Names of groups of edges on planes of symmetry.
        slides: Names of groups of edges that slide in a plane.
        moved: Names of groups of held edges that are moved as a rigid body.

    Raises:
        InputError: If it cannot be read, is no suitable surface, or is not supported everywhere.
    """
    file = Path(path)
    status = file.stat() if file.is_file() else None
    seen = (status.st_mtime_ns, status.st_size) if status else None
    return _read(path, unit, (tuple(held), tuple(mirrors), tuple(slides)), tuple(moved), seen)


@lru_cache(maxsize=8)
def _read(
    path: str,
    unit: float,
    named: tuple[tuple[str, ...], ...],
    moved: tuple[str, ...],
    _seen: tuple[int, int] | None,
) -> Reference:
    refuse = Refusal(path)
    read = read_mesh(Path(path), refuse.named, ("triangle", "triangle6"))
    blocks = [block for block in read.cells if block.type.startswith("triangle")]
    if len({block.type for block in blocks}) > 1:
        refuse("it has triangles of 3 and of 6 nodes; allowed: one kind")
    cells = np.vstack([block.data for block in blocks]).astype(np.int64)
    cells = cells[:, ORDER] if cells.shape[1] == 6 else cells
    used = np.unique(cells)
    points, cells = compact(np.asarray(read.points, float) / unit, cells)
    points = np.column_stack([points, np.zeros((len(points), 3 - points.shape[1]))])
    number = np.full(len(read.points), -1)
    number[used] = np.arange(len(used))
    groups = {name: number[edges] for name, edges in _groups(read).items()}
    open_edges = _require_surface(points, cells, unit, refuse)
    every, _ = edges_of(cells[:, :3])
    known = keys(every)
    held, mirrors, slides = named
    for (one, names), (other, others) in combinations(zip(KINDS, named, strict=True), 2):
        for name in {*names} & {*others}:
            refuse(f"group {name!r} is both in {one} and in {other}; allowed: in one of them")
    for name in (*held, *mirrors, *slides, *moved):
        if name not in groups:
            refuse(f"no group of edges is called {name!r}{not_among(name, [*groups] or ['none'])}")
        if not np.isin(keys(groups[name]), known).all():
            refuse(f"group {name!r} has edges that are edges of no triangle")
    given = Surface(points, cells[:, :3], refuse)
    mirrored, sliding = (
        find({name: groups[name] for name in names})
        for find, names in ((given.mirrors, mirrors), (given.slides, slides))
    )
    moving = keys(np.vstack([*mirrored.values(), *sliding.values(), np.empty((0, 2), int)]))
    if held:
        fixed = np.vstack([groups[name] for name in held])
    else:
        fixed = open_edges[~np.isin(keys(open_edges), moving)]
    given = Reference(points, cells, fixed, mirrored, slides=sliding)
    if "Z" in mirrored and "Z" in sliding:
        _require_one_height(given, refuse)
    _require_supported(given, open_edges, [*groups], refuse)
    if moved:
        given = _moving(given, {name: groups[name] for name in moved}, refuse)
    return given.upwards() if given.is_flat else given


def _moving(given: Reference, groups: Mapping[str, np.ndarray], refuse: Refusal) -> Reference:
    """The same surface with groups of edges that are moved, about the middle of their length."""
    held = keys(given.held)
    for name, edges in groups.items():
        if not np.isin(keys(edges), held).all():
            refuse(f"group {name!r} of moved is not held; allowed: groups of edges that are held")
    moved = np.vstack([*groups.values()])
    rest = given.held[~np.isin(held, keys(moved))]
    others = np.vstack([rest, *given.mirrors.values(), *given.slides.values()])
    shared = np.intersect1d(moved, others)
    if len(shared):
        refuse(
            f"edges of moved meet edges with another support {at(given.points[shared[0]])}; allowed: whole "
            "edges of the surface, such as a ring"
        )
    ends = given.points[moved]
    length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
    return replace(given, moved=moved, pivot=length @ ends.mean(axis=1) / length.sum())


def _require_one_height(given: Reference, refuse: Refusal) -> None:
    """Refuse edges that move in horizontal planes of two heights: the load has no potential there."""
    heights = [given.points[edges["Z"][0, 0], 2] for edges in (given.mirrors, given.slides)]
    if abs(heights[1] - heights[0]) > PLANE * given.size:
        refuse(
            f"edges of mirror lie in Z = {heights[0]:.6g}, edges of slide in Z = {heights[1]:.6g}; a load on "
            "edges that move at two heights has no potential; allowed: one height; hold one of these groups"
        )


def _groups(read: meshio.Mesh) -> dict[str, np.ndarray]:
    """Edges by the name of their physical group, or by its number if it has no name."""
    names = {(int(tag), int(dim)): name for name, (tag, dim) in read.field_data.items()}
    parts: dict[str, list[np.ndarray]] = {}
    for block, tags in zip(read.cells, read.cell_data.get("gmsh:physical", ()), strict=False):
        if block.type in ("line", "line3"):
            for tag in np.unique(tags):
                name = names.get((int(tag), 1), str(int(tag)))
                parts.setdefault(name, []).append(block.data[tags == tag][:, :2].astype(np.int64))
    return {name: np.vstack(edges) for name, edges in parts.items()}


def _require_surface(points: np.ndarray, cells: np.ndarray, unit: float, refuse: Refusal) -> np.ndarray:
    """Refuse what is no surface of a size near one, and return its open edges."""
    if len(points) and np.isfinite(points).all():
        half = float(np.ptp(points, axis=0).max()) / 2
        if not half:
            refuse("all its nodes are at one point")
        if not EXTENT[0] <= half <= EXTENT[1]:
            refuse(
                f"half of its largest extent is {half:.4g} times unit = {unit:g}; allowed: {EXTENT[0]:g} to "
                f"{EXTENT[1]:g}; set unit to the length, as in the file, by which numbers are divided, such "
                f"as unit = {half * unit:.3g}"
            )
    corners, inverse = compact(points, cells[:, :3])
    edges = require_manifold(corners, inverse, refuse)
    if cells.shape[1] == 6:
        _require_regular(points, cells, refuse)
    return np.unique(cells[:, :3])[edges]


def _require_regular(points: np.ndarray, cells: np.ndarray, refuse: Refusal) -> None:
    """Refuse curved triangles that are turned inside out at one of their nodes."""
    step = 1e-6
    x = points[cells]
    along = [(quadratics(NODES + s) - quadratics(NODES - s)) / (2 * step) for s in step * np.eye(2)]
    a, b = (np.einsum("qi,mid->mqd", part, x) for part in along)
    straight = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0])
    wrong = np.flatnonzero((np.einsum("mqd,md->mq", np.cross(a, b), straight) <= 0).any(axis=1))
    if len(wrong):
        refuse(
            f"{len(wrong)} curved triangles are turned inside out at a node, the first {at(x[wrong[0], 0])}; "
            "allowed: none"
        )


def _require_supported(given: Reference, open_edges: np.ndarray, groups: list[str], refuse: Refusal) -> None:
    """Refuse edges without support, triangles turned over, and rigid motions."""
    supported = keys(np.vstack([given.held, *given.mirrors.values(), *given.slides.values()]))
    free = open_edges[~np.isin(keys(open_edges), supported)]
    if len(free):
        names = f"; groups of this file: {', '.join(groups)}" if groups else ""
        place = at(given.points[free[0]].mean(axis=0))
        refuse(
            f"{len(free)} edges are neither held nor on a mirror, the first {place}, nor do they slide: "
            f"a pressure on a membrane with a free edge has no potential; add their group to held{names}"
        )
    if np.isin(given.corners, given.held).all():
        refuse("every corner of a triangle is held; allowed: a surface with corners that are free to move")
    if not len(given.held) and rigid_motions(given):
        refuse(
            "no edge is held: it may move as a rigid body; allowed without a held edge: mirrors X, Y and Z, "
            "or edges that slide in one of these planes instead"
        )
    if given.is_flat:
        if any(abs(given.direction[AXES.index(axis)]) > 0.5 for axis in given.mirrors):
            refuse(
                "a group of mirror lies in the plane of the flat sheet; allowed: planes that cut the sheet; "
                "edges that slide in the plane of the sheet belong to slide"
            )
        total = given.normals.sum(axis=0)
        wrong = np.flatnonzero(given.normals @ total <= 0)
        if len(wrong):
            place = at(given.points[given.corners[wrong[0], 0]])
            refuse(
                f"{len(wrong)} triangles of the flat sheet are turned over, the first {place}; allowed: none"
            )
