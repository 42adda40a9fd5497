"""Tests of the reference codes, by room: one folder for each folder of ``reference_data/solvers``.

pytest puts this folder on the path, so that every room can import ``committed_tables`` and ``led_astray``.
"""
