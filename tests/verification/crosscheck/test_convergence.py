"""Curves of several meshes: order, limit, and a verdict on both."""

from io import StringIO

import jsonschema
import numpy as np
import pytest
from rich.console import Console

from weakforms import InputError, compare
from weakforms.verification.cases import references
from weakforms.verification.cases.catalogue import WORDS, print_verdicts
from weakforms.verification.run.requests import schema

CASE, NAME = "paper2.fig03", "fig03a_delta1_1.1"
TABLE = references.load(2, NAME).columns
CELLS = (10, 20, 40)


def curve(cells, order=2.0, off=0.0, size=1.0, part=slice(None)):
    """A curve of a code of this order, which may converge to something else than the table."""
    u, p = TABLE["u_max"][part], TABLE["p"][part]
    error = size * (0.4 + 0.3 * np.cos(2 * u)) * (1.0 / cells) ** order * (1 + 0.2 / cells)
    return {"u_max": u, "p": p * (1 + error + off * u)}


def judged(curves, **how):
    verdicts = compare(CASE, curves, NAME, only=["p"], **how)
    jsonschema.validate(verdicts.to_json(), schema("verdicts"))
    (found,) = verdicts.convergence
    return verdicts, found


@pytest.mark.parametrize("order", [1.0, 2.0, 4.0])
def test_order_and_limit_are_found(order):
    verdicts, found = judged([curve(n, order) for n in CELLS])
    assert (verdicts.status, verdicts.exit_status, found.status) == ("passed", 0, "passed")
    assert found.order == pytest.approx(order, abs=0.05)
    assert found.errors[0] > found.errors[1] > found.errors[2] > 10 * abs(found.limit_error)
    assert verdicts.verdicts[0].asked is None, "a coarse curve claims nothing by default"


def test_other_ratios_and_other_rows():
    curves = [
        curve(n, part=part)
        for n, part in zip((9, 27, 81), (slice(0, None, 2), slice(None), slice(1, -1)), strict=True)
    ]
    verdicts, found = judged(curves, ratio=3)
    assert found.order == pytest.approx(2, abs=0.05)
    assert verdicts.passed
    assert judged(curves, ratio=2)[1].order == pytest.approx(2 * np.log2(3), abs=0.05)


def test_a_terminal_shows_the_verdict_on_convergence():
    verdicts, found = judged([curve(n) for n in CELLS])
    with StringIO() as screen:
        print_verdicts(verdicts, Console(file=screen, width=200))
        assert f"p: {WORDS[found.status]}: {found.text}" in screen.getvalue()


def test_convergence_to_something_else_fails():
    verdicts, found = judged([curve(n, off=1e-4) for n in CELLS])
    assert (verdicts.status, found.status) == ("failed", "failed")
    assert found.order == pytest.approx(2, abs=0.05)
    assert "not to the table" in found.detail


def test_curves_that_do_not_approach_each_other_fail():
    verdicts, found = judged([curve(n) for n in (10, 40, 10)])
    assert (verdicts.status, found.order) == ("failed", None)
    assert "do not approach" in found.detail


def exact(cells, order):
    """A curve whose error is one power of the size of the cells and nothing else."""
    return {"u_max": TABLE["u_max"], "p": TABLE["p"] * (1 + 0.1 * float(cells) ** -order)}


def test_the_limit_of_a_pure_power_is_the_table():
    found = judged([exact(n, 2) for n in CELLS])[1]
    assert found.order == pytest.approx(2, abs=1e-6)
    assert abs(found.limit_error) < 1e-11


def test_an_uncertain_limit_is_not_judged():
    """Errors that hardly shrink have a limit, but nobody knows it: a whole order is far away."""
    verdicts, found = judged([exact(n, 0.1) for n in CELLS])
    assert (verdicts.status, found.status) == ("not judged", "not judged")
    assert "too coarse" in found.detail


def test_the_finest_curve_is_judged_too_if_it_claims_an_accuracy():
    curves = [curve(n) for n in CELLS]
    reached = judged(curves)[0].verdicts[0].reached
    assert judged(curves, accuracy=1.01 * reached)[0].passed
    assert judged(curves, accuracy=0.9 * reached)[0].status == "failed"


def test_too_few_meshes_are_refused():
    with pytest.raises(InputError, match="needs 3"):
        compare(CASE, [curve(10), curve(20)], NAME)
    with pytest.raises(InputError, match="ratio"):
        compare(CASE, [curve(n) for n in CELLS], NAME, ratio=0.5)


@pytest.mark.parametrize(("certain", "status"), [(11, "not judged"), (12, "passed")])
def test_more_than_half_of_the_rows_must_have_a_certain_limit(certain, status):
    """The first rows have no error; two powers of the cell size make the limit of the others uncertain."""
    curves = []
    for n in CELLS:
        rows = {name: TABLE[name][:22].copy() for name in ("u_max", "p")}
        rows["p"][certain:] *= 1 + 0.1 / n + 1.0 / n**2
        curves.append(rows)
    assert len(curves[0]["p"]) == 22
    assert judged(curves, accuracy=1e-4)[1].status == status
