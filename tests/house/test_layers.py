"""Structure of the code: allowed imports, documented public names, no trace of a particular machine."""

import ast
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
STDLIB = set(sys.stdlib_module_names) - {"test"}
FENICS = {"dolfinx", "ufl", "basix", "ffcx", "cffi", "petsc4py", "slepc4py", "mpi4py"}
TREES = ("weakforms", "cases", "reference_data", "tests")
MAY = {
    "weakforms/forms": {"ufl", "basix.ufl", "weakforms.forms"},
    "weakforms/solvers": {
        *FENICS,
        "numpy",
        "scipy",
        "weakforms.solvers",
        "weakforms.results",
        "weakforms.errors",
    },
    "weakforms/problems": {
        *FENICS,
        "numpy",
        "scipy",
        "pydantic",
        "gmsh",
        "meshio",
        "weakforms.problems",
        "weakforms.forms",
        "weakforms.solvers",
        "weakforms.results",
        "weakforms.errors",
    },
    "weakforms/results": {
        *("numpy", "jsonschema", "weakforms.results", "weakforms.errors"),
        *("matplotlib", "pandas", "xarray"),  # inside functions only, see below
    },
    "weakforms/errors.py": set(),
    "cases": {"weakforms", "numpy", "scipy"},
    "reference_data": {"numpy", "scipy", "reference_data"},
}
"""What each part may import besides the standard library."""


def files(*folders: str) -> list[Path]:
    paths = [ROOT / folder for folder in folders]
    found = [p for path in paths for p in ([path] if path.is_file() else sorted(path.rglob("*.py")))]
    assert found
    return found


def imported(tree: ast.AST, package: str) -> Iterator[str]:
    """Every module imported anywhere in a file; ``from a import b`` counts as ``a`` and as ``a.b``."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            parts = package.split(".")[: len(package.split(".")) - node.level + 1]
            base = ".".join([*parts, node.module or ""]).strip(".") if node.level else node.module
            yield base
        elif isinstance(node, ast.Call) and ast.unparse(node.func).endswith(("import_module", "__import__")):
            yield from (str(given.value) for given in node.args[:1] if isinstance(given, ast.Constant))


def forbidden(path: Path, allowed: set[str], top_only: bool = False) -> list[str]:
    package = ".".join(path.relative_to(ROOT).parent.parts)
    out = []
    for name in imported(ast.parse(path.read_text("utf-8")), package):
        known = name in allowed if top_only else any(name == a or name.startswith(f"{a}.") for a in allowed)
        if name.split(".")[0] not in STDLIB and not known:
            out.append(name)
    return out


def test_zeros_are_sought_in_one_place():
    """Without a change of sign, scipy raises a ValueError; only one module may handle it."""
    users = [path.name for path in files("weakforms") if "brentq" in path.read_text("utf-8")]
    assert users == ["roots.py"]


@pytest.mark.parametrize("part", MAY)
def test_imports_point_one_way(part):
    wrong = {p.name: f for p in files(part) if (f := forbidden(p, MAY[part]))}
    assert wrong == {}


def test_results_are_read_and_written_without_anything_that_may_be_missing():
    """Pictures and tables of other packages are imported where they are made."""
    blocked = "import sys; sys.modules.update(dict.fromkeys(['matplotlib', 'pandas', 'xarray'])); "
    code = f"{blocked}import weakforms.results.plot, weakforms.results.frames, weakforms.results.notebook"
    assert subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=False).returncode == 0


def test_forms_take_only_the_elements_of_basix():
    assert forbidden(files("weakforms/forms")[0], {"ufl"}) in ([], ["basix.ufl"])


def test_cases_use_only_the_public_name():
    found = {
        name
        for p in files("cases")
        for name in imported(ast.parse(p.read_text("utf-8")), "")
        if name.startswith("weakforms")
    }
    assert found == {"weakforms.cases"}


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ("import weakforms.problems", "weakforms.problems"),
        ("def f():\n    from weakforms.verification import case", "weakforms.verification"),
        ("from .. import verification", "weakforms"),
        ("import importlib\nimportlib.import_module('dolfinx')", "dolfinx"),
    ],
)
def test_the_check_sees_through(text, name):
    assert name in imported(ast.parse(text), "weakforms.results")


def test_nothing_of_weakforms_is_imported_by_the_references_when_they_run():
    code = (
        "import sys, reference_data.solvers.registry as r; r.tables()\n"
        "print(*{m.split('.')[0] for m in sys.modules} & {'weakforms', 'dolfinx', 'ufl', 'petsc4py'})"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


def test_no_two_test_modules_have_one_name():
    """Test modules are imported by their names; pytest refuses the second one."""
    names = [path.name for path in files("tests") if path.name.startswith("test_")]
    assert len(names) == len(set(names))


def test_no_folder_is_crowded():
    crowded = {}
    for folder in {path.parent for path in files(*TREES)}:
        modules = [path.name for path in folder.glob("*.py") if path.name != "__init__.py"]
        if len(modules) > 15:
            crowded[folder.relative_to(ROOT).as_posix()] = len(modules)
    assert crowded == {}


def test_no_module_is_long():
    """A module beyond this has two subjects; it is split by them, not by its length."""
    lengths = {path: len(path.read_text("utf-8").splitlines()) for path in files(*TREES)}
    assert {path.relative_to(ROOT).as_posix(): lines for path, lines in lengths.items() if lines > 350} == {}


@pytest.mark.parametrize("part", ["problems", "verification"])
def test_tests_are_in_the_room_of_what_they_test(part):
    rooms = {path.parent.relative_to(ROOT / "tests" / part).as_posix() for path in files(f"tests/{part}")}
    assert {room for room in rooms if not (ROOT / "weakforms" / part / room).is_dir()} == set()
    assert len(rooms) > 4


def arrows() -> dict[str, set[str]]:
    """The modules of the tree that each module imports, including imports for type checkers."""
    paths = {dotted(path): path for path in files("weakforms", "reference_data")}
    out = {}
    for name, path in paths.items():
        tree = ast.parse(path.read_text("utf-8"))
        inside = {id(n) for f in ast.walk(tree) if isinstance(f, ast.FunctionDef) for n in ast.walk(f)}
        found = set()
        for node in ast.walk(tree):
            if isinstance(node, ast.ImportFrom) and id(node) not in inside:
                found |= {f"{node.module}.{a.name}" for a in node.names} | {str(node.module)}
        # A package that is named for one of its modules is not imported for its own sake.
        out[name] = {m for m in found if m in paths and m != name and paths[m].name != "__init__.py"}
    return out


def dotted(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__")


def test_no_modules_import_each_other_in_a_circle():
    left = arrows()
    while leaves := {name for name, others in left.items() if not others & left.keys()}:
        left = {name: others for name, others in left.items() if name not in leaves}
    assert left == {}


PAGES = [
    "README.md",
    "CONTRIBUTING.md",
    *sorted(p.relative_to(ROOT).as_posix() for p in ROOT.glob("docs/*.md")),
]


@pytest.mark.parametrize("page", PAGES)
def test_a_page_names_files_that_exist(page):
    """A file or folder of the tree given with its path; ``paperN`` and ``*`` match any name."""
    text = (ROOT / page).read_text("utf-8")
    added = set(re.findall(r"(?m)^`([\w/]+\.py)`:$", text))  # files whose text follows on the page
    named = re.findall(r"(?<![\w/.])((?:weakforms|cases|reference_data|tests|docs)/[\w/.*-]*[\w*/])", text)
    lost = {
        path
        for path in named
        if not any(ROOT.glob(path.strip("/").replace("paperN", "paper[0-9]"))) and "NAME" not in path
    }
    assert lost <= added


RAW = {"_write", "_write_loads", "_mark", "_give_up", "mark", "put", "rewrite", "set_state", "set_loads"}
"""What changes the state of forms without a context."""

OWNERS = {
    "weakforms/solvers/equilibrium/state.py": RAW,
    "weakforms/solvers/equilibrium/system.py": {"_give_up"},
    "weakforms/solvers/equilibrium/newton.py": {"rewrite"},
    "weakforms/solvers/equilibrium/subspace.py": {"rewrite"},
    "weakforms/solvers/stability/modes.py": {"_write", "_give_up"},
    "weakforms/problems/liquid_tube/bent/front.py": {"_write_loads", "put"},
    "weakforms/problems/diagram/bodies/wrinkled.py": {"mark"},
}
"""The modules that own it: states, Newton's methods, second variations, and the meshes with fronts."""


def test_nobody_else_puts_a_state():
    for path in files("weakforms"):
        name = path.relative_to(ROOT).as_posix()
        calls = [n for n in ast.walk(ast.parse(path.read_text("utf-8"))) if isinstance(n, ast.Call)]
        called = {c.func.attr for c in calls if isinstance(c.func, ast.Attribute)}
        assert called & RAW <= OWNERS.get(name, set()), f"{name} puts a state without a context"


def test_only_compat_looks_at_versions():
    looking = {
        p.relative_to(ROOT / "weakforms").as_posix()
        for p in files("weakforms")
        for node in ast.walk(ast.parse(p.read_text("utf-8")))
        if isinstance(node, ast.Attribute) and ast.unparse(node) == "dolfinx.__version__"
    }
    assert looking == {"solvers/support/compat.py", "solvers/support/provenance.py"}
    for path in files("weakforms"):
        if path.name != "provenance.py":
            names = set(imported(ast.parse(path.read_text("utf-8")), ""))
            assert not names & {"importlib.metadata", "pkg_resources", "packaging.version"}, path


def test_verbs_that_solve_nothing_need_no_dolfinx():
    code = "import sys, weakforms.cli; print(*{'dolfinx', 'petsc4py', 'matplotlib'} & set(sys.modules))"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True, check=True)
    assert done.stdout.strip() == ""


# -- style ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("command", [("check", "--no-cache"), ("format", "--check", "--no-cache")])
def test_ruff(command):
    if shutil.which("ruff") is None:
        pytest.skip("ruff is not installed here")
    done = subprocess.run(["ruff", *command, "."], cwd=ROOT, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_ruff_wants_docstrings_and_annotations_in_the_package():
    lint = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["ruff"]["lint"]
    assert {"D", "ANN", "F", "E"} <= set(lint["select"])
    ignored = {*lint["ignore"]} | {
        rule
        for pattern, rules in lint.get("per-file-ignores", {}).items()
        if not pattern.startswith("tests")
        for rule in rules
    }
    assert {r for r in ignored if r.startswith(("D", "ANN"))} <= {"D105", "D107", "ANN401"}


def test_everything_public_has_a_docstring_and_annotations():
    bare = []
    for path in files("weakforms"):
        tree = ast.parse(path.read_text("utf-8"))
        bare += [str(path)] if ast.get_docstring(tree) is None else []
        bodies = [(tree, "")] + [(n, n.name) for n in tree.body if isinstance(n, ast.ClassDef)]
        for body, owner in bodies:
            for node in body.body:
                if isinstance(node, ast.FunctionDef | ast.ClassDef) and not f"{owner}{node.name}".startswith(
                    "_"
                ):
                    hidden = node.name.startswith("_")
                    if not hidden and ast.get_docstring(node) is None:
                        bare.append(f"{path.name}:{node.lineno} {node.name}")
                    if isinstance(node, ast.FunctionDef) and not hidden and node.returns is None:
                        bare.append(f"{path.name}:{node.lineno} {node.name} ->")
    assert bare == []


# -- nothing of the machines this was written on -------------------------------------------------

PRIVATE = re.compile(
    "|".join(
        [
            "/work/" + "(?:main|shared)",
            "(?:docker|quay|gcr|ghcr)" + r"\.io\b(?!/library/)",  # Docker Hub's own images are public
            r"https?://[^\s\"'<>)]*(?:registry|mirror|proxy|artifactory|nexus)",
            r"\bhttps?://(?:10|192\.168|172\.(?:1[6-9]|2\d|3[01]))\.\d",
            "/home" + r"/[a-z]",
        ]
    )
)


def test_no_file_tells_of_a_machine_or_registry():
    listed = subprocess.run(
        ["git", "-c", "safe.directory=*", "ls-files", "-co", "--exclude-standard"],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    if listed.returncode:
        paths = [
            p for tree in TREES for p in (ROOT / tree).rglob("*") if p.suffix in (".py", ".csv", ".toml")
        ]
    else:
        paths = [ROOT / name for name in listed.stdout.splitlines()]
    assert len(paths) > 50
    found = []
    for path in paths:
        if path.is_file():
            text = path.read_bytes().decode("utf-8", "replace")
            found += [f"{path.relative_to(ROOT)}: {hit[0]}" for hit in PRIVATE.finditer(text)]
    assert found == []


@pytest.mark.parametrize(
    "text", ["see /work/" + "main", "FROM docker" + ".io/x", "https:" + "//mirror.local/x"]
)
def test_that_check_would_see_one(text):
    assert PRIVATE.search(text)
