"""Whether the suite can be trusted: uncertainties, seeded faults, comparison of runs, speed."""
