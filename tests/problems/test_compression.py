"""Where the ordinary energy leaves a membrane in compression: a remark of the result."""

import re
from functools import cache
from types import SimpleNamespace

import numpy as np
import pytest

from weakforms import solve
from weakforms.problems.meridian import compression as module
from weakforms.problems.meridian.compression import AROUND, TAUT, UNRESOLVED, compression
from weakforms.solvers.continuation.curve import Solved
from weakforms.verification.cases.references import ROOT

pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")
MESH = {"cells": 48, "levels": 2, "step": 0.2}
TABLE = np.genfromtxt(ROOT / "reference_data/beyond/tube_waves_wrinkling.csv", delimiter=",", names=True)
NUMBER = re.compile(r"(\w+|\|Z\|) = (-?[\d.]+)\((\d+)\)")


@cache
def told(problem="tube", **given):
    result = solve(problem, numerics=MESH, **given)
    return [text for text in result.warnings if "compressed" in text]


def numbers(text):
    """Name, value and uncertainty of each number of a remark, in order."""
    return [
        (name, float(value), int(last) * 10.0 ** -len(value.partition(".")[2]))
        for name, value, last in NUMBER.findall(text)
    ]


def test_a_tube_says_from_where_to_where_it_is_compressed():
    (text,) = told(alpha=0.0, u_end=3.6)
    assert text.startswith("the tube is compressed around the axis from u_max = ")
    assert text.endswith("; energy = relaxed lets it wrinkle")
    onset, end = TABLE[(TABLE["lf"] == 6) & (TABLE["alpha"] == 0)]
    wanted = [*((name, onset[column]) for name, column in (("u_max", "u_max"), ("p", "p"), ("Z", "Z_t_min")))]
    wanted.append(("u_max", end["u_max"]))
    found = numbers(text)
    assert [name for name, *_ in found] == [name for name, _ in wanted]
    for (_, got, uncertainty), (_, value) in zip(found, wanted, strict=True):
        assert abs(got - value) < uncertainty < 1e-3 * value


def test_a_whole_tube_says_the_same_of_both_ends():
    one, other = (numbers(told(alpha=0.0, u_end=2.0, extent=e)[0]) for e in ("half", "full"))
    assert [name for name, *_ in other] == ["u_max", "p", "|Z|"]
    assert [row[1] for row in one] == pytest.approx([row[1] for row in other], abs=1e-5)


@pytest.mark.parametrize(("end", "remarks"), [(1.5, 0), (1.55, 1)])
def test_compression_beyond_the_end_of_the_branch_is_not_told(end, remarks):
    assert len(told(alpha=0.0, u_end=end)) == remarks


def test_the_place_is_where_a_resultant_is_zero_and_not_a_dry_part_without_any():
    given = {"delta": 1.05, "L": 20.0, "gamma": 0.3, "n_max": 1}
    result = solve("fluid_tube", numerics={"levels": 2}, **given)
    (text,) = [text for text in result.warnings if "compressed" in text]
    (_, volume, _), (_, _, _), (_, z, _) = numbers(text)
    assert volume == pytest.approx(25.99698087, abs=1e-6)  # on twice as many cells
    assert z == pytest.approx(0.16861745, abs=1e-5)


@pytest.mark.parametrize(
    "given",
    [
        {"alpha": 0.1},
        {"alpha": 0.0, "u_end": 2.0, "energy": "relaxed"},
        {"problem": "fluid_tube", "delta": 4.0, "L": 20.0},
    ],
)
def test_a_taut_membrane_has_no_remark(given):
    assert told(**given) == []


def test_what_cannot_be_relaxed_is_not_advised():
    (text,) = told(alpha=0.0, u_end=2.0, extent="full", uneven=0.1)
    assert text.endswith("on; a real one wrinkles there")


def test_a_tube_of_liquid_is_compressed_where_its_hoop_resultant_is_zero():
    given = {"delta": 1.05, "L": 8.0, "gamma": 0.3, "alpha": 0.1, "n_max": 1}
    (text,) = told("fluid_tube", **given)
    (volume, zw, z) = (value for _, value, _ in numbers(text))
    with_state = solve("fluid_tube", at={"V": volume}, numerics=MESH, **given)
    (state,) = with_state.states
    columns = state.fields[0].columns
    assert state.quantities["zw"].value == pytest.approx(zw, abs=1e-4)
    lowest = np.argmin(columns["T2"])
    assert columns["T2"][lowest] == pytest.approx(0, abs=2e-3)
    assert abs(columns["Z"][lowest] - z) <= np.diff(columns["Z"]).max()


@pytest.mark.parametrize(
    ("least", "error", "sign"),
    [(1e-12, 0.0, 1), (-9e-6, 0.0, 0), (-2e-5, 0.0, -1), (-2e-5, 1e-4, 0), (-2e-4, 1e-4, -1)],
)
def test_the_error_of_a_mesh_is_no_compression(monkeypatch, least, error, sign):
    monkeypatch.setattr(module, "_at_nodes", lambda _curve, state: (state, 1.0))
    curve = SimpleNamespace(points=[SimpleNamespace(state=least)])
    assert module._signs(curve, error).tolist() == [sign]


def stand_in(zeros, signs):
    """A family of two meshes with given zeros of the smallest resultant."""
    levels = [SimpleNamespace(zeros=at, signs=np.array(signs)) for at in zeros]
    return SimpleNamespace(levels=levels, across=("p", "u"))


def zero(u, kind):
    return Solved({"u": u, "p": 1.0, "Z": 2.0}, None, kind)


@pytest.mark.parametrize(
    ("zeros", "signs", "text"),
    [
        ([], [1, 1], ""),
        ([], [-1, -1], "is compressed from its first state on"),
        ([(3.0, TAUT)], [-1, 1], "is compressed from its first state to u = 3"),
        ([(1.0, AROUND)], [1, -1], "is compressed around the axis from u = 1 (p = 1, at Z = 2) on"),
        (
            [(1.0, AROUND), (2.0, TAUT), (4.0, AROUND)],
            [1, -1, 1, -1],
            "is compressed around the axis from u = 1 (p = 1, at Z = 2) to u = 2, and is compressed around "
            "the axis from u = 4 (p = 1, at Z = 2) on",
        ),
    ],
)
def test_all_parts_of_a_branch_are_told(monkeypatch, zeros, signs, text):
    monkeypatch.setattr(module, "_signs", lambda curve, _error: curve.signs)
    monkeypatch.setattr(module, "_zeros", lambda curves, *_: curves[0].zeros)
    monkeypatch.setattr(module, "_errors", lambda curves: [0.0 for _ in curves])
    same = [zero(*at) for at in zeros]
    told = compression(stand_in([same, same], signs), "Z", 4.0)
    assert re.sub(r"\.0+\(\d+\)", "", told) == text


@pytest.mark.parametrize("signs", [[1, -1], [0, -1]])
def test_what_the_meshes_do_not_resolve_has_no_number(monkeypatch, signs):
    monkeypatch.setattr(module, "_signs", lambda curve, _error: curve.signs)
    monkeypatch.setattr(module, "_zeros", lambda curves, *_: curves[0].zeros)
    monkeypatch.setattr(module, "_errors", lambda curves: [0.0 for _ in curves])
    text = compression(stand_in([[], [zero(1.0, AROUND)] * (signs[0] > 0)], signs), "Z", 4.0)
    assert text == UNRESOLVED
