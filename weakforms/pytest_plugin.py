"""A pytest fixture for other packages: assert that their curve agrees with a reference table.

Installing the package registers it; without installation use ``pytest -p weakforms.pytest_plugin``.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from weakforms.verification.crosscheck.verdicts import Verdicts

CurveLike = str | Path | Mapping[str, Sequence[float]]


@pytest.fixture(scope="session")
def weakforms_check() -> Callable[..., Verdicts]:
    """``weakforms_check(case, curve, name=None, accuracy=None)``: fails with the table of verdicts.

    The fixture accepts all arguments of :func:`weakforms.compare`. It also fails if there is no verdict ("not
    judged"), unless ``unjudged=True`` allows this: a column is missing, or no accuracy is claimed and the
    curve needs one, or the table is too coarse.
    """
    from weakforms.errors import InputError
    from weakforms.verification.crosscheck.compare import compare
    from weakforms.verification.crosscheck.rows import NOT_JUDGED

    def check(
        case: str,
        curve: CurveLike,
        name: str | None = None,
        accuracy: float | None = None,
        columns: Mapping[str, str] | None = None,
        constants: Mapping[str, float] | None = None,
        only: Sequence[str] | None = None,
        branch: str | None = None,
        unjudged: bool = False,
        **more: Any,
    ) -> Verdicts:
        __tracebackhide__ = True
        try:
            verdicts = compare(case, curve, name, accuracy, columns, constants, only, branch, **more)
        except InputError as error:
            pytest.fail(f"nothing was compared: {error}", pytrace=False)
        if not verdicts.passed and not (unjudged and verdicts.status == NOT_JUDGED):
            pytest.fail(_table(verdicts), pytrace=False)
        return verdicts

    return check


def _table(verdicts: Verdicts) -> str:
    """The table that ``weakforms compare`` prints."""
    import io

    from rich.console import Console

    from weakforms.verification.cases.catalogue import print_verdicts

    text = io.StringIO()
    print_verdicts(verdicts, Console(file=text, width=110, highlight=False))
    return text.getvalue()
