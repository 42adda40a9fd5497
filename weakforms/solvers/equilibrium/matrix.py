"""Matrices of bilinear forms, which dolfinx adds up and PETSc uses."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from dolfinx import cpp, fem, la
from petsc4py import PETSc

from weakforms.solvers.support import compat


def pattern_of(form: fem.Form) -> cpp.la.SparsityPattern:
    """Places of the entries that the forms on one space can have."""
    pattern = fem.create_sparsity_pattern(form)
    pattern.finalize()
    return pattern


class FormMatrix:
    """The matrix of bilinear forms on one space.

    PETSc would search a row for each entry that an element adds, which takes several times as long as the
    forms themselves. Therefore dolfinx adds them up. On one rank PETSc uses the arrays of dolfinx; on several
    ranks it is given whole rows.

    Args:
        space: The space of the test and the trial functions.
        pattern: Places of the entries.
        bcs: Dirichlet conditions.
        held: Degrees of freedom that they hold, of those that this rank owns.
    """

    def __init__(
        self,
        space: fem.FunctionSpace,
        pattern: cpp.la.SparsityPattern,
        bcs: Sequence[fem.DirichletBC],
        held: np.ndarray,
    ) -> None:
        self.pattern, self._bcs, self._comm = pattern, bcs, space.mesh.comm
        self._sum = la.matrix_csr(pattern, la.BlockMode.expanded)
        rows, columns = (self._sum.index_map(i) for i in (0, 1))
        self._starts = self._sum.indptr[: rows.size_local + 1].astype(PETSc.IntType)
        self._entries = int(self._starts[-1])
        numbers = np.repeat(np.arange(rows.size_local, dtype=np.int32), np.diff(self._starts))
        diagonal = np.flatnonzero(self._sum.indices[: self._entries] == numbers)
        self._held = diagonal[np.isin(numbers[diagonal], held)]
        """Places of the diagonal entries of held degrees of freedom."""
        self._columns = self._sum.indices[: self._entries].astype(PETSc.IntType, copy=False)
        if self._comm.size > 1:
            everywhere = np.arange(columns.size_local + columns.num_ghosts, dtype=np.int32)
            self._columns = columns.local_to_global(everywhere).astype(PETSc.IntType)[self._columns]
        self._sizes = ((rows.size_local, rows.size_global),) * 2
        block = space.dofmap.index_map_bs
        make = PETSc.Mat().createAIJWithArrays if self._comm.size == 1 else PETSc.Mat().createAIJ
        self.petsc: PETSc.Mat = make(self._sizes, bsize=block, csr=self._rows(), comm=self._comm)

    def _rows(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Starts of the rows of this rank, and columns and values of their entries."""
        return self._starts, self._columns, self._sum.data[: self._entries]

    def assemble(self, form: fem.Form) -> None:
        """Make it the matrix of a form, with the identity in rows of Dirichlet conditions."""
        self._add_up(form, 1.0)
        if self._comm.size > 1:
            self.petsc.setValuesCSR(*self._rows())
        self.petsc.assemble()

    def _add_up(self, form: fem.Form, diagonal: float) -> None:
        self._sum.set_value(0.0)
        compat.add_up(self._sum, form, self._bcs)
        self._sum.scatter_reverse()
        self._sum.data[self._held] = diagonal

    def without_zeros(self, form: fem.Form) -> PETSc.Mat:
        """Another matrix, of a form that has many zeros, without them.

        Two thirds of a mass matrix of three components are zeros. Rows of Dirichlet conditions are zero.
        """
        kept = self._sum.data.copy()
        self._add_up(form, 0.0)
        starts, columns, values = self._rows()
        wanted = np.flatnonzero(values)
        starts = np.searchsorted(wanted, starts).astype(PETSc.IntType)
        parts = starts, columns[wanted], values[wanted]
        self._sum.data[:] = kept
        return PETSc.Mat().createAIJ(self._sizes, csr=parts, comm=self._comm)
