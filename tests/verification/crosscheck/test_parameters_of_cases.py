"""What a result must be for, to be compared with the table of a case."""

import json

from weakforms.results import CurveFile
from weakforms.verification.cases import references
from weakforms.verification.cases.discovery import find_cases
from weakforms.verification.crosscheck.columns import require_same_parameters


def test_every_case_fits_its_own_tables_parameters():
    """The curve of any case would be accepted as its result: the rule knows all parameters."""
    for found in find_cases():
        for panel in found.case.panels:
            for curve in panel.curves:
                if curve.reference is not None:
                    table = references.load_curve(found.paper, curve.reference)
                    own = dict(curve.of.parameters)
                    given = CurveFile(table.columns, curve.of.problem, json.loads(json.dumps(own)))
                    require_same_parameters(given, table, curve)
