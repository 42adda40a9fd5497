r"""Are the stated uncertainties right? True errors of coarse solutions over many sets of parameters.

A problem is solved on coarse meshes at parameters drawn from a Sobol sequence, and again on meshes four times
as fine with polynomials two degrees higher: against the coarse uncertainty :math:`u` the fine solution is the
truth, its own :math:`u_t` being known and smaller by orders. What is claimed of every number:

* its true error is within :math:`u + u_t` for 95 % of all numbers, and within the bound that verdicts use,
  :math:`2u + u_t`, for all of them;
* for each column, over the sets, :math:`u` is at most 30 times the error (:func:`~.judged.statistics`), where
  an error below the floor counts as the floor: ten times
  :data:`~weakforms.solvers.uncertainty.refinement.ALGEBRAIC` of the number or of 1,
  the part of each uncertainty that is there for round-off, which no mesh can show.

The rules for uncertainties were chosen with the sets of :mod:`.families` in view. Those of :mod:`.hold_out`
have another seed and wider ranges, and hold every problem that states an uncertainty from refinement;
no rule was ever changed for their sake. ``weakforms coverage`` solves either.
"""
