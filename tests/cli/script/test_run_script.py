"""The script `run`: where it runs a command, what it passes on, and its messages if something is missing.

Docker, podman, buildah and the rest are replaced by programs that record their arguments. No image is built,
so these tests are quick and run inside the image as well.
"""

import os
import signal
import subprocess

import pytest
from stand_in_machine import status_of_run, values

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
