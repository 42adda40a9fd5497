"""Bad input to the problems of Paper 4: exit status 2 and one line, before anything is solved."""

import pytest

pytestmark = pytest.mark.paper4


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--set", "M=0"], "M = '0': input should be greater than 0"),
        (["--set", "M=2"], "less than 2"),
        (["--set", "M=-0.5"], "greater than 0"),
        (["--set", "delta=1"], "greater than 1"),
        (["--set", "delta=0.9"], "greater than 1"),
        (["--set", "Af=0"], "'critical' or a number above 0"),
        (["--set", "Af=-1"], "'critical' or a number above 0"),
        (["--set", "Af=big"], "'critical' or a number above 0"),
        (["--set", "energy=hencky"], "energy"),
        (["--set", "load=steam"], "'fluid' or 'gas'"),
        (["--set", "gamma=0"], "greater than 0"),
        (["--set", "gamma=0.1", "--set", "load=gas"], "allowed with load = 'fluid'"),
        (["--set", "c2=-0.1"], "greater than or equal to 0"),
        (["--set", "L=0"], "greater than or equal to 1"),
        (["--set", "wind=1"], "no parameter 'wind'"),
        (["--mesh", "degree=1"], "degree = '1': input should be greater than or equal to 2"),
        (["--at", "p=0.1"], "there is no p"),
        (["--set", "load=gas", "--at", "zw=3"], "there is no zw"),
        (["--at", "zw=-1"], "must be 0 or more"),
        (["--at", "front=1"], "request a state"),
        (["--at", "r_max=1"], "cannot ask for a state at 'r_max'"),
        (["--at", "zw=nan"], "not a finite number"),
    ],
)
def test_bad_input_ends_with_2_and_one_line(weakforms, solves, arguments, told):
    done = weakforms("solve", "wrinkled_tube", *arguments)
    assert (done.status, done.out, solves) == (2, "", [])
    assert told in done.err
    assert len(done.err.strip().splitlines()) == 1


@pytest.mark.parametrize(
    ("problem", "arguments", "told"),
    [
        ("wrinkled_sheet", ["--set", "at_load=0"], "greater than 0"),
        ("wrinkled_tube_threshold", ["--set", "upper=perhaps"], "upper"),
        ("wrinkled_material", ["--set", "l1=0"], "greater than 0"),
        ("wrinkled_material", ["--at", "W=1"], "cannot ask for a state"),
    ],
)
def test_so_do_the_other_problems(weakforms, solves, problem, arguments, told):
    done = weakforms("solve", problem, *arguments)
    assert (done.status, solves) == (2, [])
    assert told in done.err
