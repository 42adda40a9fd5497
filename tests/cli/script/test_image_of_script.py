"""The images that the script `run` builds: when, from what, and which one a command uses."""

import re

import pytest
from stand_in_machine import ROOT, status_of_run, values

# --- which image ---------------------------------------------------------------------------------


@pytest.mark.parametrize("option", [["--image", "sid"], ["--image=sid"]])
def test_sid_is_an_image_of_its_own(machine, option):
    machine.put("docker", "case $1 in image) exit 1 ;; run) exit 0 ;; esac")
    assert machine.run("list").returncode == 0
    usual = machine.tag()
    assert machine.run(*option, "list").returncode == 0
    assert machine.tag() == f"{usual}-sid"
    given = [values(call, "--build-arg") for call in machine.calls("docker", "build")]
    assert given == [["DEBIAN=trixie"], ["DEBIAN=sid"]]


def test_sid_is_not_what_is_installed_here(machine):
    machine.put_dolfinx()
    machine.put("docker", status_of_run(6))
    assert machine.run("--image", "sid", "list").returncode == 6


# --- the image -----------------------------------------------------------------------------------


def test_image_is_built_once(machine):
    built = machine.tree.parent / "built"
    machine.put("docker", f"case $1 in image) [[ -e {built} ]] ;; build) : > {built} ;; run) exit 3 ;; esac")
    first, second = machine.run("list"), machine.run("list")
    assert (first.returncode, second.returncode) == (3, 3)
    assert "about 3 minutes" in first.stderr
    assert second.stderr == ""
    (call,) = machine.calls("docker", "build")
    assert values(call, "--target") == ["deps"]
    assert values(call, "-t") == [machine.tag()]


def test_what_the_image_copies_is_sent_to_the_engine():
    """A file that .dockerignore leaves out ends the build."""
    lines = (ROOT / "Dockerfile").read_text().splitlines()
    copied = {name for line in lines if line.startswith("COPY ") for name in line.split()[1:-1]}
    rules = (ROOT / ".dockerignore").read_text().split("\n")
    assert len(copied) > 8
    assert rules[1] == "*"
    assert copied <= {rule[1:] for rule in rules if rule.startswith("!")}
    assert all((ROOT / name).exists() for name in copied)


def test_failed_build_shows_its_log(machine):
    machine.put("docker", "case $1 in image) exit 1 ;; build) echo disk is full; exit 9 ;; esac")
    done = machine.run("list")
    assert done.returncode == 4
    assert "disk is full" in done.stderr
    assert not machine.calls("docker", "run")


def test_tag_follows_what_the_image_is_made_from(machine):
    machine.put("docker", status_of_run(0))
    dockerfile = machine.tree / "Dockerfile"
    text = dockerfile.read_text()

    def tag(changed: str) -> str:
        dockerfile.write_text(changed)
        assert machine.run("list").returncode == 0
        return machine.tag()

    before = tag(text)
    assert re.fullmatch(r"weakforms-deps:[0-9a-f]{12}", before)
    assert tag(text) == before
    assert tag("# a remark\n" + text) == before
    assert tag(text + "\nRUN true\n") == before, "the final stage does not belong to it"
    assert tag(text.replace("python3-gmsh", "python3-gmsh python3-h5py")) != before


def test_ruff_is_pinned_once(machine):
    pins = [
        re.findall(r"ruff==([\d.]+)", (machine.tree / name).read_text())
        for name in ("Dockerfile", "pyproject.toml")
    ]
    assert pins[0] == pins[1]
    machine.put("docker", status_of_run(0))
    assert machine.run("lint").returncode == 0
    assert machine.tag().startswith("weakforms-lint:")


@pytest.mark.parametrize(("words", "stage"), [(["--pdf"], "lint"), ([], "deps")])
def test_only_printing_the_report_needs_the_browser(machine, words, stage):
    machine.put("docker", status_of_run(0))
    assert machine.run("report", "out", *words).returncode == 0
    assert machine.tag().startswith(f"weakforms-{stage}:")


def test_the_version_is_asked_of_the_program(machine):
    machine.put("docker", status_of_run(0))
    assert machine.run("--version").returncode == 0
    (call,) = machine.calls("docker", "run")
    assert call[-1] == "--version"


def test_image_builds_the_final_stage(machine):
    machine.put("docker")
    assert machine.run("image").returncode == 0
    (call,) = machine.calls("docker", "build")
    assert values(call, "--target") == ["final"]
    version = re.search(r'^version = "(.*)"', (machine.tree / "pyproject.toml").read_text(), re.M)[1]
    assert values(call, "-t") == [f"weakforms:{version}"]
