"""What a problem promises: its parameters, columns, laws and scaling, held against a stored copy.

Other codes rely on these names, ranges, defaults and units, and on their meaning. They may grow, but a change
has to be seen: ``contract/PROBLEM.json`` is the copy, and the command in :data:`RENEW` writes it again.
"""

import json
from dataclasses import asdict
from pathlib import Path

import pytest

from weakforms.problems import registry
from weakforms.verification.cases.catalogue import describe

STORED = Path(__file__).parent / "contract"
RENEW = "./run shell -c 'python3 -m tests.house.test_contract'"
PROBLEMS = sorted(registry.abouts())
SHOWN = ("parameters", "numerics", "scales", "materials", "command")
"""What `weakforms show` adds to the text of the problem's folder."""


def contract(name):
    """All that is declared of a problem, as JSON holds it."""
    shown, problem = describe(name), registry.get(name)
    facts = asdict(registry.abouts()[name]) | {key: shown[key] for key in SHOWN if key in shown}
    for part in ("parameters", "numerics"):
        facts[f"{part} as JSON schema"] = getattr(problem, part).model_json_schema()["properties"]
    return json.loads(json.dumps(facts))


@pytest.mark.parametrize("name", PROBLEMS)
def test_a_problem_keeps_what_it_promises(name):
    path = STORED / f"{name}.json"
    assert path.exists(), f"a new problem: write its copy with {RENEW}"
    assert contract(name) == json.loads(path.read_text("utf-8")), f"if this is meant, write it with {RENEW}"


def test_no_copy_is_left_of_a_problem_that_is_gone():
    assert sorted(path.stem for path in STORED.glob("*.json")) == PROBLEMS


if __name__ == "__main__":
    for path in STORED.glob("*.json"):
        path.unlink()
    for problem in PROBLEMS:
        text = json.dumps(contract(problem), indent=1, ensure_ascii=False)
        (STORED / f"{problem}.json").write_text(f"{text}\n", "utf-8")
