"""Is it right: cases, references, uncertainties, verdicts, report."""
