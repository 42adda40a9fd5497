"""The machine on which the script `run` is tested."""

import pytest
from stand_in_machine import Machine


@pytest.fixture
def machine(tmp_path):
    return Machine(tmp_path)
