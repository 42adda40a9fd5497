"""Curves made of the rows of a table, and the verdict on them."""

import json

import jsonschema

from weakforms import compare
from weakforms.verification.cases import references
from weakforms.verification.run.requests import schema

FREE = ("paper1.free", "free_alpha_0.1_beta_2")
TUBE = ("paper2.fig03", "fig03a_delta1_1.1")
PIECE = ("closed_form.test_pieces", "uniaxial_neo_hookean")


def columns_of(which, part=slice(None), **factors):
    paper = which[0].split(".")[0]
    table = references.load(int(paper[-1]) if paper.startswith("paper") else paper, which[1])
    return {name: values[part] * factors.get(name, 1.0) for name, values in table.columns.items()}


def verdict_on(which, curve, *more, **how):
    verdicts = compare(which[0], curve, which[1], *more, **how)
    jsonschema.validate(verdicts.to_json(), schema("verdicts"))
    json.dumps(verdicts.to_json(), allow_nan=False)
    return verdicts
