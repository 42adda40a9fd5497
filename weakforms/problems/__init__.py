"""Physical problems: mesh, unknowns, energy, boundary conditions, functionals, contact history.

A problem is one folder: ``about.py`` says what it is, what it computes and how it is tested, and needs no
dolfinx; ``problem.py`` and the modules beside it have its parameters and its weak form.
:mod:`weakforms.problems.registry` finds both; no list names them.
"""
