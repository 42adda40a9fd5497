"""What a user may set is described: `show PROBLEM` and the pages print these texts."""

import pytest

from weakforms.problems import registry

PROBLEMS = sorted(registry.problems())


@pytest.mark.parametrize("name", PROBLEMS)
@pytest.mark.parametrize("part", ["parameters", "numerics"])
def test_every_parameter_has_a_description(name, part):
    fields = getattr(registry.get(name), part).model_fields
    assert [key for key, field in fields.items() if not field.description] == []
