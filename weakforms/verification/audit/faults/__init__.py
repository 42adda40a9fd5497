"""Seeded faults: named small changes of the source, each of which some check must notice.

A suite is worth what it would notice. The catalogue (``*.toml`` beside this file) changes one thing at a
time in a scratch copy of the tree; :func:`~weakforms.verification.audit.faults.runner.run_faults` says which
check caught it.
"""
