"""All numbers of two solutions are compared, and all differences are named."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from weakforms.errors import InputError
from weakforms.results import Branch, Failure, Field, Quantity, Result, SpecialPoint, State
from weakforms.verification.audit import same
from weakforms.verification.audit.elsewhere import NAME, elsewhere, load_elsewhere, write_elsewhere
from weakforms.verification.audit.same import Run, differences, main, runs, table
from weakforms.verification.judging.outcome import RunOutcome
from weakforms.verification.report.beside import Beside
from weakforms.verification.report.pages import render
from weakforms.verification.report.report import write_report


def solution(**changed: float) -> Result:
    """A small solution with all kinds of numbers; single numbers may be changed."""
    at = {
        "p": 1.0,
        "rho": 2.0,
        "limit": 3.0,
        "energy": 4.0,
        "mode": 5.0,
        "split": 1e-14,
        "count": 1,
        "critical": 1e-6,
    } | changed
    field = Field("profile", {"Z": np.array([0.0, 1.0]), "rho": np.array([1.0, at["rho"]])}, {"rho": 1e-6})
    return Result(
        problem="tube",
        parameters={},
        scales={},
        numerics={},
        provenance={},
        branches=[
            Branch(
                "primary",
                "p",
                {
                    "p": np.array([0.0, at["p"], np.nan]),
                    "n_negative": np.array([0, int(at["count"]), 1]),
                    "residual": np.random.default_rng().random(3),
                },
            )
        ],
        special_points=[SpecialPoint("limit_point", "primary", "p", {"p": at["limit"]}, {"p": 1e-3})],
        quantities={"energy": Quantity(at["energy"]), "split": Quantity(at["split"], 1e-10)}
        | {"Lambda_1_stable": Quantity(at["critical"])},
        states=[State({"p": 1.0}, "primary", {"eigenvalue_1": Quantity(at["mode"], 1e-9)}, (field,))],
    )


def test_the_same_is_the_same():
    assert max(item.relative for item in differences(solution(), solution())) == 0
    empty = solution()
    branch = empty.branches[0]
    empty.branches[0] = replace(branch, columns={name: column[:0] for name, column in branch.columns.items()})
    assert max(item.relative for item in differences(empty, empty)) == 0


@pytest.mark.parametrize(
    ("name", "place", "scale"),
    [
        ("p", "branch primary, p", 3.0),  # that of the limit point's p
        ("rho", "profile rho", 2.0),
        ("limit", "special point 1 (limit_point, primary), p", 3.0),
        ("energy", "quantity energy", 4.0),
        ("mode", "state p = 1 (crossing 1, primary), eigenvalue_1", 5.0),
    ],
)
def test_one_number_that_moved_is_found_and_named(name, place, scale):
    start = {"p": 1.0, "rho": 2.0, "limit": 3.0, "energy": 4.0, "mode": 5.0}[name]
    worst, *others = differences(solution(), solution(**{name: start - 1e-7}))
    assert place in worst.place
    assert worst.relative == pytest.approx(1e-7 / scale, rel=1e-6)
    assert all(item.relative == 0 for item in others)


def test_a_count_is_the_same_or_not():
    worst = differences(solution(), solution(count=0))[0]
    assert worst.relative == np.inf
    assert "n_negative" in worst.place


def test_a_zero_has_no_scale_of_its_own():
    assert differences(solution(), solution(split=-3e-14))[0].relative < 1e-13


def test_what_is_missing_or_failed_on_one_side_is_infinitely_far():
    less, failed, shorter, without = (solution() for _ in range(4))
    less.states.clear()
    failed.failures.append(Failure("state at p = 2", "diverged"))
    shorter.branches[0].columns["p"] = np.zeros(2)
    without.branches[0].columns["p"][1] = np.nan  # where the other has a number
    for other in (less, failed, shorter, without):
        assert differences(solution(), other)[0].relative == np.inf


def test_uncertainties_count_where_they_are_no_noise():
    other = solution()
    other.special_points[0].uncertainty["p"] = 2e-3
    worst = differences(solution(), other)[0]
    assert worst.place.endswith("p, uncertainty")
    assert worst.relative == pytest.approx(1e-3 / 3)
    other.special_points[0].uncertainty["p"] = 1.0005e-3
    assert differences(solution(), other)[0].relative == 0


def test_eigenvalues_near_zero_have_the_scale_of_others():
    worst = differences(solution(), solution(critical=1e-6 + 1e-12))[0]
    assert worst.place == "quantity Lambda_1_stable"
    assert worst.relative == pytest.approx(1e-10, rel=1e-3)


def stored(folder: Path, result: Result, passed: bool = True) -> Path:
    """The parts of a run with one case and one solution that the test needs."""
    (folder / "solutions").mkdir(parents=True)
    (folder / "report").mkdir()
    versions = dict.fromkeys(("dolfinx", "ufl", "ffcx", "basix", "petsc", "slepc", "git"), "0")
    result.provenance = {**versions, "ranks": 1, "wall_s": 0.0}
    (folder / "solutions" / "a.json").write_text(json.dumps(result.to_json()))
    case = {
        "id": "paper2.fig03",
        "solutions": [{"spec": "tube()", "file": "solutions/a.json"}],
        "verdicts": [{"check": "p", "passed": passed}],
    }
    (folder / "report" / "report.json").write_text(json.dumps({"cases": [case]}))
    return folder


def test_runs_are_compared_case_by_case(tmp_path, capsys):
    first = stored(tmp_path / "a", solution())
    second = stored(tmp_path / "b", solution(energy=4.4), passed=False)
    (found,) = runs(Run(first), Run(second))
    assert found.worst.relative == pytest.approx(0.4 / 4.4)
    assert "| paper2.fig03 | 9 | p | 9.1e-02 | `tube(): quantity energy` |" in table(Run(first), Run(second))
    assert main([str(first), str(second)]) == 0
    assert capsys.readouterr().out.count("paper2.fig03") == 1
    assert main([str(first), str(tmp_path / "c")]) == 2
    assert main([str(first)]) == 2
    (second / "solutions" / "a.json").unlink()
    assert runs(Run(first), Run(second))[0].worst.relative == same.np.inf


def test_the_solution_that_differs_most_comes_first_and_one_that_neither_run_has_is_no_difference(tmp_path):
    both = []
    for name, shift in (("a", 0.0), ("b", 0.4)):
        folder = stored(tmp_path / name, solution())
        report = json.loads((folder / "report" / "report.json").read_text())
        files = {"near": "a.json", "far": "b.json", "never": "c.json"}
        specs = [{"spec": spec, "file": f"solutions/{file}"} for spec, file in files.items()]
        report["cases"][0]["solutions"] = specs
        (folder / "report" / "report.json").write_text(json.dumps(report))
        far = solution(energy=4.0 + shift)
        far.provenance = json.loads((folder / "solutions" / "a.json").read_text())["provenance"]
        (folder / "solutions" / "b.json").write_text(json.dumps(far.to_json()))
        both.append(Run(folder))
    found = runs(*both)
    assert [(item.spec, item.worst.relative) for item in found[1:]] == [("near", 0.0), ("never", 0.0)]
    assert (found[0].spec, found[0].worst.relative) == ("far", pytest.approx(0.4 / 4.4))


def test_another_run_stands_in_the_report(tmp_path):
    first = stored(tmp_path / "a", solution())
    second = stored(tmp_path / "b", solution(energy=4.4), passed=False)
    report = json.loads((second / "report" / "report.json").read_text())
    (second / "report" / "report.json").write_text(json.dumps(report | {"environment": {"ranks": "4"}}))
    found = elsewhere(first, second)
    write_elsewhere([found], tmp_path)
    (read,) = load_elsewhere(tmp_path)
    assert read == found
    assert found.environment == {"ranks": "4"}
    run = RunOutcome("full", "", "2026-01-01T00:00:00+00:00", 1.0, {})
    assert "ranks 4" in write_report(run, tmp_path, stored=True).read_text("utf-8")
    assert "ranks 4" not in write_report(run, tmp_path).read_text("utf-8"), "other numbers than the compared"
    write_elsewhere([found], tmp_path)
    page = render(RunOutcome("full", "", "2026-01-01T00:00:00+00:00", 1.0, {}), Beside(others=(found,)))[
        "index.html"
    ]
    assert "ranks 4" in page
    assert "9.1e-02" in page
    assert load_elsewhere(first) == ()
    (tmp_path / NAME).write_text('{"runs": [{"rows": 3}]}')
    with pytest.raises(InputError, match="report --other"):
        load_elsewhere(tmp_path)
    report["cases"][0]["id"] = "paper2.fig04"
    (second / "report" / "report.json").write_text(json.dumps(report))
    with pytest.raises(InputError, match="no case"):
        elsewhere(first, second)


def test_a_number_that_is_missing_on_one_side_is_a_difference():
    assert same._apart([1.0, None, None], [1.5, 2.0, None]).tolist() == [0.5, np.inf, 0.0]
