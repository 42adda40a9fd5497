"""Curves that are no curves: exit status 2, one line that says why, and nothing done."""

import json
from pathlib import Path

import pytest

COMPARE = "compare paper2.fig03 --curve fig03a_delta1_1.1"
GOOD = "u_max,p\n" + "\n".join(f"{0.05 * k:g},{k / 9:g}" for k in range(1, 12))


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("c.csv", b"", "header row"),
        ("c.csv", b"\n\n\n", "header row"),
        ("c.csv", b"u_max,p\n", "header row"),
        ("c.csv", bytes(range(256)) * 20, "not UTF-8 byte 128"),
        ("c.csv", GOOD.encode("utf-16"), "not UTF-8 byte 0"),
        ("c.csv", "u_max,p,größe\n1,2,3".encode("latin-1"), "not UTF-8"),
        ("c.csv", b"\0" * 200_000, "c.csv"),
        ("c.csv", b"x,p\n1,2\n2,3", "'u_max' x, p"),
        ("c.csv", b"u_max,q\n1,2\n2,3", "p, lam1_mid u_max, q"),
        ("c.csv", GOOD.replace(",", ";").encode(), "u_max;p"),
        ("c.csv", b"u_max,p\n1,2\n\n2,3,4\n", "line 4 3 cells 2 column"),
        ("c.csv", b"u_max,p,p\n1,2,3\n2,3,4", "repeated 'p'"),
        ("c.csv", b"u_max,p\n1,2\n2,nan", "'p' row 2 'nan'"),
        ("c.csv", b"u_max,p\n1,2\n2,", "'p' row 2 '' finite number"),
        ("c.csv", b"u_max,p\n1,2\n2,inf", "'inf' finite"),
        ("c.csv", b"u_max,p\n1,2\n2,1e999", "'1e999' finite"),
        ("c.csv", b"u_max,p\n1,2\n3,2\n2,2", "u_max must rise, or fall"),
        ("c.csv", b"u_max,p\n1,2\n1,2\n2,2", "u_max must rise, or fall"),
        ("c.csv", b"u_max,p\n1e300,1e300\n1e301,-1e301", "1e+300 [0.05, 5]"),
        ("c.csv", b"u_max,p\n" + b"9" * 140_000 + b",1\n", "c.csv"),
        ("c.json", b"", "not JSON"),
        ("c.json", b"[1, 2]", "object list"),
        ("c.json", b"3", "object int"),
        ("c.json", b"{}", "no columns"),
        ("c.json", b"[" * 1_000_000, "not JSON"),
        ("c.json", b'{"u_max": ' + b"[" * 900 + b"]" * 900 + b', "p": [1]}', "'u_max'"),
        ("c.json", b'{"u_max": [' + b"9" * 5000 + b"]}", "not JSON"),
        ("c.json", b'{"u_max": [' + b"9" * 400 + b"]}", "'u_max' finite number"),
        ("c.json", b'{"u_max": [1, 2], "p": [1, NaN]}', "'p' row 2 'nan'"),
        ("c.json", b'{"u_max": [1, 2], "p": [1, null]}', "'p' row 2 'None'"),
        ("c.json", b'{"u_max": [1, 2], "p": [true, 1]}', "'p' row 1 'True'"),
        ("c.json", b'{"u_max": [1, 2], "p": [1]}', "differ in length"),
        ("c.json", b'{"u_max": [1, 2], "p": "12"}', "'p' list of numbers"),
        ("c.json", b'{"columns": [1]}', "'columns' object"),
        ("c.json", b'{"u_max": [1, 2], "p": [1, 2], "\xff": 1}', "not UTF-8"),
        ("c.json", b'{"schema": "weakforms.result/1"}', "weakforms.result/1 required"),
        ("c.json", b'{"schema": "weakforms.result/2", "p": [1]}', "'schema' list of numbers"),
    ],
)
def test_curve_files(refused, name, content, said):
    Path(name).write_bytes(content)
    refused(f"{COMPARE} {name}", *said.split())


def test_curve_that_is_no_file(refused, monkeypatch):
    Path("folder").mkdir()
    refused(f"{COMPARE} missing.csv", "missing.csv", "No such file")
    refused(f"{COMPARE} folder", "folder", "Is a directory")
    refused([*COMPARE.split(), "\x1b[31m/none"], "No such file")
    monkeypatch.setattr("weakforms.results.curves.MAX_CURVE_BYTES", 2**20)
    refused(f"{COMPARE} /dev/zero", "/dev/zero", "larger than 1 MiB")


def test_result_without_numbers_is_no_curve(refused, weakforms):
    out = weakforms("solve", "tube").out  # the canned one
    data = json.loads(out)
    for branches, said in (([], "without a branch"), (data["branches"] * 2, "u_max")):
        Path("c.json").write_text(json.dumps(data | {"branches": branches}))
        with pytest.MonkeyPatch.context():
            found = weakforms(*COMPARE.split(), "c.json")
        assert (found.status, said in found.err) == (2, True)


def test_control_characters_do_not_reach_the_terminal(weakforms):
    called = weakforms("show", "\x1b[31mred\x07")
    assert called.status == 2
    assert "\x1b" not in called.err
    assert "\x07" not in called.err
