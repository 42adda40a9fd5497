"""Cross-check of another code: sfepy's Mooney-Rivlin balloon, a 3-D ball in a membrane.

The model is an example of sfepy (``sfepy.examples.large_deformation.balloon``), unchanged: the volume of
a coarse ball is prescribed and its pressure is computed. Its units are kept: c1 = 3e5, c2 = c1/10, r0 = 1,
h0 = 0.01. The mesh is accurate to about 2 %, and the curve claims this accuracy.
Run: ``python examples/sfepy_balloon.py`` (needs sfepy and weakforms; no DOLFINx).
"""

import sys
import tempfile
from typing import Any

import numpy as np
from sfepy.base.base import output
from sfepy.base.conf import ProblemConf
from sfepy.discrete import Problem
from sfepy.examples.large_deformation import balloon

import weakforms

output.set_output(quiet=True)
balloon.output.set_output(quiet=True)
stretches, pressures = [], []


def note(_problem: Any, steps: Any, variables: Any) -> None:
    """Relative stretch and pressure of a time step."""
    stretches.append(1.0 + steps.time)
    pressures.append(float(np.mean(variables["p"]())))


conf = ProblemConf.from_dict(balloon.define(), balloon)
with tempfile.TemporaryDirectory() as folder:
    conf.options.output_dir = folder
    problem = Problem.from_conf(conf)
    problem.solve(step_hook=note, save_results=False)

verdicts = weakforms.compare(
    "closed_form.sphere",
    {"lam": stretches[1:], "P": pressures[1:]},  # without the ball at rest
    name="sphere_mooney_rivlin",
    accuracy=0.02,
    constants={"r_o": 1.0, "S": 3e5, "h_o": 1e-2},
)
worst = verdicts.verdicts[0]
print(f"{worst.statement}: error {worst.signed_error:+.1e}, bound {worst.bound:.1e} at {worst.where}")
print(f"judged over lam in {verdicts.covered}; {verdicts.ignored_rows} rows beyond the table")
print(verdicts.status)
sys.exit(verdicts.exit_status)
