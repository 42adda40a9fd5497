"""Verification: cases, references, uncertainties, verdicts, report."""
