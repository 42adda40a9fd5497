"""Runs of the suite: plan, solve, store, judge."""
