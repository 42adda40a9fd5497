"""The rule by which two numbers agree."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

FACTOR = 2.0
"""Largest difference of two numbers that agree, in combined uncertainties."""


@dataclass(frozen=True)
class Comparison:
    """Errors of an array against a reference, with their bounds; all relative to ``scale``."""

    error: np.ndarray
    bound: np.ndarray
    uncertainty: np.ndarray
    reference_uncertainty: float
    scale: float

    @property
    def worst(self) -> int:
        """Index with the largest ratio of error to bound."""
        return int(np.argmax(self.error / np.maximum(self.bound, np.finfo(float).tiny)))

    def passed(self, asked: float) -> bool:
        """Whether every error is within its bound, and every bound is smaller than the accuracy asked for.

        A NaN fails.
        """
        return bool(np.all(self.error <= self.bound) and np.all(self.bound <= asked))


def compare(
    values: np.ndarray,
    uncertainty: np.ndarray | float,
    reference: np.ndarray,
    reference_uncertainty: float,
    scale: float | None = None,
) -> Comparison:
    r"""Compare values with a reference.

    .. math:: |v - v_{ref}| \le 2 \sqrt{u^2 + u_{ref}^2}

    Both uncertainties come from refinement, so that nobody chooses a tolerance.

    Args:
        values: Values of the weak form.
        uncertainty: Its absolute uncertainty.
        reference: Values of the reference.
        reference_uncertainty: Its absolute uncertainty.
        scale: Divisor of the errors; by default the largest magnitude of the reference.
    """
    values, reference = np.atleast_1d(values), np.atleast_1d(reference)
    size = float(scale if scale is not None else np.max(np.abs(reference)))
    size = size or 1.0
    own = np.broadcast_to(np.asarray(uncertainty, dtype=float), values.shape)
    bound = FACTOR * np.hypot(own, reference_uncertainty)
    return Comparison(
        error=np.abs(values - reference) / size,
        bound=bound / size,
        uncertainty=own / size,
        reference_uncertainty=reference_uncertainty / size,
        scale=size,
    )
