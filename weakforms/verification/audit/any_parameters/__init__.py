"""The audit: solves at parameters drawn over all that a problem allows, and what became of each.

A problem promises an answer anywhere in its ranges. The ranges are read off its ``Parameters``, values are
drawn with a seed of the day, and each set is solved by the command line in a process of its own.
"""
