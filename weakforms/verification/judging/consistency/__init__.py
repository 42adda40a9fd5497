"""A solution held against itself: traces, marks and identities between columns."""
