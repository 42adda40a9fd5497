"""Audits of the suite itself: uncertainties, seeded faults, comparison of runs, speed."""
