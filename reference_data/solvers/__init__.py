"""Independent reference codes (numpy and scipy only).

They share nothing with the weak forms they are held against: no constitutive law, no
functional, no discretisation. ``python -m reference_data.solvers --list`` names the tables.
"""
