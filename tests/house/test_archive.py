"""The archive of a version, the types for editors, and the files in ``examples/ci`` that others copy."""

import hashlib
import io
import json
import os
import re
import subprocess
import zipfile
from pathlib import Path

import pytest

from weakforms.archive import METADATA, NEEDED, SUMS, write_archive
from weakforms.docs.stubs import STUBS, stubs
from weakforms.errors import InputError
from weakforms.verification.crosscheck.compare import compare

ROOT = Path(__file__).resolve().parents[2]
CI = ROOT / "examples" / "ci"


def git(tree, *words):
    names = {f"GIT_{who}_{what}": "a@b.c" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
    subprocess.run(["git", "-C", tree, *words], check=True, capture_output=True, env=os.environ | names)


@pytest.fixture
def tree(tmp_path):
    """A small tree with everything that an archive needs, committed."""
    out = tmp_path / "tree"
    for name in (*NEEDED, "reference_data/paper2/fig03b.csv"):
        (out / name).parent.mkdir(parents=True, exist_ok=True)
        (out / name).write_bytes((ROOT / name).read_bytes() if (ROOT / name).is_file() else b"1,2\n")
    git(tmp_path, "init", "-q", out)
    git(out, "add", "-A")
    git(out, "commit", "-qm", "all")
    return out


def test_an_archive_has_every_file_with_its_checksum(tree, tmp_path):
    digest = write_archive(tree, tmp_path / "new" / "a.zip")
    data = (tmp_path / "new" / "a.zip").read_bytes()
    assert hashlib.sha256(data).hexdigest() == digest
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        files = {name.removeprefix("weakforms/"): archive.read(name) for name in archive.namelist()}
    assert {*NEEDED, METADATA, SUMS} <= set(files)
    sums = dict(line.split("  ")[::-1] for line in files.pop(SUMS).decode().splitlines())
    assert sums == {name: hashlib.sha256(content).hexdigest() for name, content in files.items()}
    facts = json.loads(files[METADATA])
    citation = (ROOT / "CITATION.cff").read_text("utf-8")
    assert f"version: {facts['version']}\n" in citation
    assert facts["creators"] == [{"name": "The weakforms authors"}]
    assert "bifurcation" in facts["keywords"]
    assert facts["title"].startswith("weakforms: ")
    assert facts["description"].startswith("Inflation")


def test_the_same_commit_gives_the_same_bytes(tree, tmp_path):
    first = write_archive(tree, tmp_path / "a.zip")
    for path in tree.rglob("*.csv"):
        os.utime(path, (1, 1))
    assert write_archive(tree, tmp_path / "b.zip") == first


@pytest.mark.parametrize(
    ("spoil", "said"),
    [
        (lambda tree: (tree / "LICENSE").write_text("other"), "not committed"),
        (lambda tree: (git(tree, "rm", "-q", "LICENSE"), git(tree, "commit", "-qm", "x")), "has no LICENSE"),
        (lambda tree: (tree / ".git").rename(tree.parent / "away"), "no git tree"),
    ],
)
def test_what_cannot_be_archived_is_refused_and_writes_nothing(tree, tmp_path, spoil, said):
    spoil(tree)
    with pytest.raises(InputError, match=said):
        write_archive(tree, tmp_path / "out" / "a.zip")
    assert not (tmp_path / "out").exists()


def test_the_types_for_editors_are_those_of_the_problems():
    assert STUBS.read_text("utf-8") == stubs(), "write them again: python3 -m weakforms.docs.stubs"


def test_the_types_name_choices_and_constants():
    (tube,) = re.findall(r'Literal\["tube"\].*', STUBS.read_text("utf-8"))
    assert "contact: Literal['none', 'frictionless', 'adhesive'] = ..." in tube
    assert "delta1: float = ..." in tube
    assert "jm: float = ..." in tube, "a constant of another law"


def test_the_apptainer_definition_has_the_packages_of_the_image():
    def packages(text):
        listed = re.search(r"--no-install-recommends \\\n(.*?)\n *(?:&& )?apt-get clean", text, re.DOTALL)
        return listed[1].replace("\\", " ").split()

    image = (ROOT / "Dockerfile").read_text("utf-8").split("FROM deps AS lint")[0]
    assert packages((CI / "weakforms.def").read_text("utf-8")) == packages(image)


def test_the_workflow_asks_for_a_curve_that_there_is():
    text = (CI / "github.yml").read_text("utf-8")
    case, curve, column, accuracy = re.search(
        r"compare (\S+) mine.csv --name (\S+) --column (\S+) --accuracy (\S+) --json", text
    ).groups()
    mine = {"u_max": [0.5, 1.0, 1.5], column: [1.0, 1.0, 1.0]}
    assert compare(case, mine, curve, float(accuracy), only=[column]).status == "failed"
