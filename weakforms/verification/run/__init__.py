"""Runs of the suite: solve, store, judge."""
