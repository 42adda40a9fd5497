"""The script `run`: where it runs a command, what it passes on, and its messages if something is missing.

Docker, podman, buildah and the rest are replaced by programs that record their arguments. No image is built,
so these tests are quick and run inside the image as well.
"""

import os
import re
import shutil
import signal
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TOOLS = """awk bash cat chown chmod cp cut dirname flock grep id mkdir mktemp printf readlink rm sed
    sh sha256sum sleep stat tail timeout tr uname"""
CLI = """
import os, sys, time
def main():
    verb, *rest = sys.argv[1:]
    if verb == "exit":
        return int(rest[0])
    if verb == "env":
        print(*(os.environ.get(name, "-") for name in rest), os.getcwd(), sys.argv[0])
    if verb == "sleep":
        try:
            print("asleep", flush=True)
            time.sleep(30)
        except KeyboardInterrupt:
            return 130
"""


class Machine:
    """A machine that has only what a test installs, with a copy of the script in a small tree."""

    def __init__(self, folder: Path) -> None:
        self.tree = folder / "tree"
        self.bin = folder / "bin"
        self.calls_file = folder / "calls"
        self.environment = {
            "PATH": str(self.bin),
            "HOME": str(folder / "home"),
            "LANG": "C.UTF-8",
            "CALLS": str(self.calls_file),
        }
        (self.tree / "weakforms").mkdir(parents=True)
        (self.tree / "weakforms" / "__init__.py").touch()
        (self.tree / "weakforms" / "cli").mkdir()
        (self.tree / "weakforms" / "cli" / "__init__.py").write_text(CLI)
        for name in ("run", "Dockerfile", "pyproject.toml"):
            shutil.copy(ROOT / name, self.tree)
        self.bin.mkdir()
        for name in TOOLS.split():
            if path := shutil.which(name):
                (self.bin / name).symlink_to(path)
        self.put("python3", "exit 1")  # no dolfinx here
        self.put("ruff", "exit 1")

    def put(self, name: str, body: str = "exit 0") -> None:
        """Install a program that records its arguments and then runs `body`."""
        path = self.bin / name
        path.unlink(missing_ok=True)
        record = f"""{{ printf '%s\\037' {name} "$@"; echo; }} >> "$CALLS" """
        path.write_text(f"#!{shutil.which('bash')}\n{record}\n{body}\n")
        path.chmod(0o755)

    def put_dolfinx(self) -> None:
        """Make this machine look like the inside of the image."""
        path = self.bin / "python3"
        path.unlink()
        path.symlink_to(sys.executable)
        self.environment["WEAKFORMS_IN_IMAGE"] = "1"

    def run(self, *args: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
        """Call the script; `cwd` is the tree by default."""
        return subprocess.run(
            [self.tree / "run", *args],
            cwd=cwd or self.tree,
            env=self.environment,
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            timeout=30,
            check=False,
        )

    def calls(self, *beginning: str) -> list[list[str]]:
        """All calls so far that begin with these words."""
        text = self.calls_file.read_text() if self.calls_file.exists() else ""
        calls = [line.rstrip("\x1f").split("\x1f") for line in text.splitlines()]
        return [call for call in calls if call[: len(beginning)] == list(beginning)]

    def tag(self) -> str:
        """The image used by the last `docker run`."""
        return next(word for word in self.calls("docker", "run")[-1] if word.startswith("weakforms-"))


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)


def status_of_run(status: int) -> str:
    return f"if [[ $1 == run ]]; then exit {status}; fi"


def values(call: list[str], option: str) -> list[str]:
    """The values that follow each occurrence of an option."""
    return [after for before, after in pairwise(call) if before == option]


# --- before anything is started ------------------------------------------------------------------


@pytest.mark.parametrize("args", [[], ["--help"], ["-h"], ["help"]])
def test_help_needs_nothing(machine, args):
    done = machine.run(*args)
    assert done.returncode == 0
    for word in ("verify", "test", "lint", "shell", "image", "--native", "--engine", "Exit status"):
        assert word in done.stdout
    assert machine.calls() == []


@pytest.mark.parametrize("verb", ["test", "lint", "notebook", "shell", "image"])
@pytest.mark.parametrize("option", ["--help", "-h"])
def test_help_on_a_verb_of_the_script_starts_nothing(machine, verb, option):
    machine.put("docker", "exit 9")
    done = machine.run(verb, option)
    assert (done.returncode, done.stderr, machine.calls()) == (0, "", [])
    assert done.stdout.startswith("usage: ./run")
    assert verb in done.stdout.splitlines()[0].split()
    assert f"./run {verb}" in done.stdout.partition("Examples:")[2]


@pytest.mark.parametrize(
    ("args", "named"),
    [
        (["--nativ", "list"], "--nativ"),
        (["--engine", "lxc", "list"], "lxc"),
        (["--engine"], "--engine"),
        (["--image", "bullseye", "list"], "bullseye"),
        (["--image"], "--image"),
    ],
)
def test_bad_option_is_bad_input(machine, args, named):
    done = machine.run(*args)
    assert done.returncode == 2
    assert named in done.stderr


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


# --- which engine --------------------------------------------------------------------------------


def test_docker_is_first(machine):
    machine.put("docker", status_of_run(0))
    machine.put("podman", status_of_run(0))
    assert machine.run("list").returncode == 0
    assert machine.calls("docker", "run")
    assert not machine.calls("podman")


def test_docker_that_does_not_answer_is_passed_over(machine):
    machine.put("docker", "exit 1")
    machine.put("podman", status_of_run(0))
    assert machine.run("list").returncode == 0
    assert machine.calls("podman", "run")
    assert not machine.calls("docker", "run")


@pytest.mark.parametrize("option", [["--engine", "podman"], ["--engine=podman"]])
def test_engine_overrides(machine, option):
    machine.put("docker", status_of_run(0))
    machine.put("podman", status_of_run(0))
    assert machine.run(*option, "list").returncode == 0
    assert machine.calls("podman", "run")
    assert not machine.calls("docker")


def test_engine_overrides_native(machine):
    machine.put_dolfinx()
    machine.put("docker", status_of_run(6))
    assert machine.run("--engine", "docker", "list").returncode == 6


def test_wanted_engine_that_does_not_answer_is_named(machine):
    machine.put("docker", "exit 1")
    machine.put("podman", status_of_run(0))
    done = machine.run("--engine", "docker", "list")
    assert done.returncode == 4
    assert "docker does not answer" in done.stderr


def test_buildah_is_last(machine):
    machine.put("buildah", '[[ $1 != mount ]] || echo "/root-of-$2"; exit 0')
    machine.put("unshare", "exit 5")
    (machine.bin / "mmdebstrap").symlink_to("/bin/true")
    if os.getuid():
        machine.put("grep", "exit 0")  # this user has subordinate ids
        machine.put("buildah", "[[ $1 != unshare ]] || exit 5")
    assert machine.run("show", "tube").returncode == 5
    if os.getuid() == 0:
        (call,) = machine.calls("unshare")
        assert any(word.startswith("/root-of-weakforms-deps-") for word in call)
        assert call[-2:] == ["show", "tube"]


def test_nothing_available_is_named_with_its_remedy(machine):
    done = machine.run("list")
    assert done.returncode == 4
    assert "buildah is missing" in done.stderr
    assert "install buildah" in done.stderr


def test_fresh_debian(machine):
    machine.put("apt-get", "echo no route to the archive; exit 100")
    done = machine.run("list")
    assert done.returncode == 4
    if os.getuid():
        assert "sudo apt-get install buildah mmdebstrap" in done.stderr
        assert not machine.calls("apt-get")
    else:
        assert "no route to the archive" in done.stderr  # the log of what failed is shown


def test_native_without_dolfinx_is_named_with_its_remedy(machine):
    machine.put("docker", status_of_run(0))
    done = machine.run("--native", "list")
    assert done.returncode == 4
    assert "apt-get install python3-dolfinx-real" in done.stderr
    assert not machine.calls("docker")


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


# --- what goes in and what comes out -------------------------------------------------------------


@pytest.mark.parametrize("status", [0, 1, 2, 3, 4, 130])
@pytest.mark.parametrize("engine", ["docker", "podman", "native"])
def test_exit_status_is_that_of_the_verb(machine, engine, status):
    if engine == "native":
        machine.put_dolfinx()
    else:
        machine.put(engine, status_of_run(status))
    assert machine.run("exit", str(status)).returncode == status


def test_an_output_folder_is_made_on_this_side(machine, tmp_path):
    """Files in a folder that exists only in the container are lost when it ends."""
    machine.put("docker", status_of_run(0))
    (tmp_path / "there").mkdir()
    assert machine.run("verify", f"--out={tmp_path}/there/new/deep").returncode == 0
    (call,) = machine.calls("docker", "run")
    assert f"{tmp_path}/there:{tmp_path}/there" in values(call, "-v")


def test_folders_user_and_environment(machine, tmp_path):
    machine.put("docker", status_of_run(0))
    machine.environment |= {"NO_COLOR": "1", "WEAKFORMS_TRACE": "yes", "SECRET": "mine"}
    for name in ("here/sub", "results", "curves", "with blank"):
        (tmp_path / name).mkdir(parents=True)
    (tmp_path / "curves" / "c.csv").touch()
    (tmp_path / "here" / "link").symlink_to(tmp_path / "with blank")
    args = ["compare", "paper2.fig03", "../curves/c.csv", f"--out={tmp_path}/results/r.json"]
    args += ["sub/x", "link/y", "/etc/hosts"]
    assert machine.run(*args, cwd=tmp_path / "here").returncode == 0
    (call,) = machine.calls("docker", "run")
    seen = values(call, "-v")
    for folder in (machine.tree, *(tmp_path / name for name in ("here", "curves", "results", "with blank"))):
        assert f"{folder}:{folder}" in seen
    assert len(seen) == 6, "and the cache, but no folder of the image"
    assert values(call, "-w") == [str(tmp_path / "here")]
    assert values(call, "--user") == [f"{os.getuid()}:{os.getgid()}"]
    environment = values(call, "-e")
    for pair in ("NO_COLOR=1", "WEAKFORMS_TRACE=yes", "OMP_NUM_THREADS=1", f"PYTHONPATH={machine.tree}"):
        assert pair in environment
    assert not any("SECRET" in pair for pair in environment)
    assert call[-len(args) :] == args


def test_tests_run_at_the_top_of_the_tree(machine, tmp_path):
    machine.put("docker", status_of_run(0))
    assert machine.run("test", "-k", "tube or sphere", cwd=tmp_path).returncode == 0
    (call,) = machine.calls("docker", "run")
    assert values(call, "-w") == [str(machine.tree)]
    assert call[-5:] == ["python3", "-m", "pytest", "-k", "tube or sphere"]


def test_native_has_the_tree_and_one_thread(machine, tmp_path):
    machine.put_dolfinx()
    machine.put("docker", status_of_run(0))
    done = machine.run("env", "OMP_NUM_THREADS", "PYTHONPATH", cwd=tmp_path)
    assert done.stdout.split() == ["1", str(machine.tree), str(tmp_path), "weakforms"]
    assert not machine.calls("docker")


def test_interrupt_reaches_the_program(machine):
    machine.put_dolfinx()
    process = subprocess.Popen(
        [machine.tree / "run", "sleep"], env=machine.environment, stdout=subprocess.PIPE, text=True
    )
    assert process.stdout.readline() == "asleep\n"
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=10) == 130


def test_a_notebook_has_an_image_and_a_port_of_its_own(machine):
    machine.put("docker")
    machine.environment["WEAKFORMS_PORT"] = "8899"
    assert machine.run("notebook").returncode == 0
    assert machine.tag().startswith("weakforms-notebook:")
    call = machine.calls()[-1]
    assert values(call, "-p") == ["127.0.0.1:8899:8899"], "only this machine may reach it"
    assert values(call, "--port") == ["8899"]
    assert values(call, "--ip") == ["0.0.0.0"]


def test_a_port_that_is_no_number_is_bad_input(machine):
    machine.environment["WEAKFORMS_PORT"] = "no"
    done = machine.run("notebook")
    assert done.returncode == 2
    assert "WEAKFORMS_PORT" in done.stderr


def test_no_other_command_opens_a_port(machine):
    machine.put("docker")
    machine.run("list")
    assert values(machine.calls()[-1], "-p") == []


def test_an_interrupt_before_the_program_has_begun_gives_no_traceback(machine):
    machine.put_dolfinx()
    slow = "import sys, time; print('importing', flush=True); time.sleep(30)\n"
    (machine.tree / "weakforms" / "cli" / "__init__.py").write_text(slow)
    pipe = subprocess.PIPE
    process = subprocess.Popen(
        [machine.tree / "run", "list"], env=machine.environment, stdout=pipe, stderr=pipe, text=True
    )
    assert process.stdout.readline() == "importing\n"
    process.send_signal(signal.SIGINT)
    assert process.wait(timeout=10) == 130
    assert process.stderr.read() == ""
