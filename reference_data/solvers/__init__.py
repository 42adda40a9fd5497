"""Independent reference codes (numpy and scipy only).

They share nothing with the weak forms that are compared with them: no constitutive law, no functional, no
discretisation. ``python -m reference_data.solvers --list`` names the tables.
"""
