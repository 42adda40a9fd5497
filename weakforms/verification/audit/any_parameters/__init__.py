"""The audit: solves at random parameters from the whole ranges of a problem, and the outcome of each.

A problem should have an answer everywhere in its ranges. The ranges come from its ``Parameters``. Values are
drawn with the date as seed, and each set is solved by the command line in a separate process.
"""
