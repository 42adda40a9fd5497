"""Discrete equilibrium equations on one mesh: assembled residual, tangent and functionals."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager

import dolfinx.fem.petsc as fem_petsc
import numpy as np
import ufl
from dolfinx import cpp, fem, la
from mpi4py import MPI
from petsc4py import PETSc
from ufl.classes import Variable
from ufl.corealg.traversal import traverse_unique_terminals

from weakforms.errors import ConvergenceError, InputError
from weakforms.solvers.equilibrium.formulation import Formulation
from weakforms.solvers.equilibrium.matrix import FormMatrix, pattern_of
from weakforms.solvers.equilibrium.state import Lendable
from weakforms.solvers.support.jit_cache import compile_together
from weakforms.solvers.support.memory import remember
from weakforms.solvers.support.sampling import FirstLevels, Interpolant, Peak

SMALL_DISPLACEMENT = 1e-3
"""Smaller displacements count as this value in :meth:`System.force_size`: lengths are of order one, and
strains, which are their differences, contain their round-off."""

_zero: dict[str, bool] = {}
"""Whether a form is zero, by its signature, which does not depend on the mesh."""


class System(Lendable):
    r"""``R(U; λ) = 0`` with symmetric tangent ``K``, assembled at the state that it is lent to.

    Vectors are numpy arrays of the degrees of freedom that this rank owns; :meth:`dot` sums over ranks. Rows
    of Dirichlet conditions are the identity in ``K`` and zero in every derivative.
    """

    def __init__(self, formulation: Formulation) -> None:
        super().__init__(formulation)
        space = self.unknown.function_space
        remember(space.mesh)
        self.comm: MPI.Intracomm = space.mesh.comm
        self._alone = self.comm.size == 1
        self.test, self.trial = ufl.TestFunction(space), ufl.TrialFunction(space)
        self._phi = fem.Function(space)
        self._forms: dict[str, fem.Form] = {}
        self._interpolant: Interpolant | None = None
        self._peaks: dict[str, Peak] = {}
        self._levels: FirstLevels | None = None
        self._ufl = self._ufl_forms()
        compile_together(self.comm, self._ufl.values())

        self.size = len(self._owned)
        self._sums = fem.Function(space).x
        self._assembled = self._sums.array
        arrays = np.zeros((2, self.size))
        self._work = [(PETSc.Vec().createWithArray(array, comm=self.comm), array) for array in arrays]
        # The number of owned dofs from dof_indices includes ghosts if dofs are given in blocks.
        owned = [dofs[dofs < self.size] for dofs, _count in (bc.dof_indices() for bc in formulation.bcs)]
        self.bc_dofs = np.concatenate(owned) if owned else np.empty(0, dtype=np.int32)
        fem_petsc.set_bc(self._sums.petsc_vec, formulation.bcs)
        self._bc_values = self._assembled[self.bc_dofs]
        self._fixed = len(self.bc_dofs)
        self.stiffness = FormMatrix(space, self._pattern(), formulation.bcs, self.bc_dofs)
        self.matrix = self.stiffness.petsc
        self.matrix.setOption(PETSc.Mat.Option.SYMMETRIC, True)
        self.matrix.setOption(PETSc.Mat.Option.SYMMETRY_ETERNAL, True)
        self._update_mass()
        self._give_up()

    def _ufl_forms(self) -> dict[str, ufl.Form]:
        given = self.formulation
        tangent = given.tangent or ufl.derivative(given.residual, self.unknown, self.trial)
        forms = {"residual": given.residual, "tangent": tangent, "mass": given.mass}
        forms |= {f"monitor_{name}": form for name, form in given.monitors.items()}
        return forms

    def _form(self, name: str) -> fem.Form:
        """Compile a form when it is first used; the compiler's cache makes this cheap for further meshes."""
        if name not in self._forms:
            if name not in self._ufl:
                self._ufl[name] = self._rate_form(name.removeprefix("d_"))
            self._forms[name] = fem.form(self._ufl[name])
        return self._forms[name]

    def _rate_form(self, load: str) -> ufl.Form:
        """``∂R/∂λ``, compiled when needed, because few of these derivatives are used."""
        return ufl.diff(self.formulation.residual, self.formulation.loads[load][1])

    def _pattern(self) -> cpp.la.SparsityPattern:
        """Places of the entries of every form on this space."""
        return pattern_of(self._form("tangent"))

    def _mass_matrix(self) -> PETSc.Mat:
        """Mass matrix with *zero* Dirichlet rows, which add no finite eigenvalue."""
        return self.stiffness.without_zeros(self._form("mass"))

    @property
    def mass(self) -> PETSc.Mat:
        """Mass matrix, which defines the norms for arc length and for modes."""
        return self._mass

    def _update_mass(self) -> None:
        """Assemble the mass matrix again, if it depends on loads or on a moving mesh."""
        self._mass = self._mass_matrix()

    @contextmanager
    def weighed_here(self) -> Iterator[None]:
        """Context in which the mass matrix is that at the lent state's loads, which may move the mesh.

        Afterwards the old matrix defines arc length again, so that a branch does not depend on earlier
        evaluations.

        Raises:
            NoStateError: Outside of :meth:`at`.
        """
        self.require_lent()
        kept = self._mass
        self._update_mass()
        try:
            yield
        finally:
            self._mass = kept

    def shift(self, tau: float) -> None:
        """Replace ``K`` by ``K + τ M`` until the next :meth:`tangent`."""
        self.matrix.axpy(tau, self.mass, PETSc.Mat.Structure.SUBSET_NONZERO_PATTERN)

    def hold(self, dofs: np.ndarray, values: np.ndarray) -> None:
        """Prescribe additional degrees of freedom of this rank, instead of those prescribed before.

        This is for conditions that change (a contact history); the conditions of the formulation stay.
        """
        self.bc_dofs = np.concatenate([self.bc_dofs[: self._fixed], dofs]).astype(np.int32)
        self._bc_values = np.concatenate([self._bc_values[: self._fixed], values])

    # -- assembly ----------------------------------------------------------------------------

    def _vector(self, name: str) -> np.ndarray:
        self.require_lent()
        self._assembled.fill(0.0)
        fem.assemble_vector(self._assembled, self._form(name))
        self._sums.scatter_reverse(la.InsertMode.add)
        out = self._assembled[: self.size].copy()
        out[self.bc_dofs] = 0.0
        return out

    def residual(self) -> np.ndarray:
        """``R(U; λ)``; on Dirichlet rows the distance from the prescribed value, which corrects round-off."""
        out = self._vector("residual")
        out[self.bc_dofs] = self._owned[self.bc_dofs] - self._bc_values
        return out

    def load_derivative(self, name: str) -> np.ndarray:
        """``∂R/∂λ`` for one scalar."""
        return self._vector(f"d_{self._aim(name)}")

    def _aim(self, name: str) -> str:
        """Select a load for derivatives, and return the load whose compiled forms it shares."""
        if self.formulation.aim is None:
            return name
        self.formulation.aim(name)
        variable = self.formulation.loads[name][1]
        return next(other for other, (_, v) in self.formulation.loads.items() if v is variable)

    def tangent(self) -> PETSc.Mat:
        """``K = ∂R/∂U``, always the same matrix object."""
        self.require_lent()
        self.stiffness.assemble(self._form("tangent"))
        held = self.bc_dofs[self._fixed :]
        if self.sum(len(held)):
            self.matrix.zeroRowsColumns(held + self.matrix.getOwnershipRange()[0])
        return self.matrix

    def monitors(self) -> dict[str, float]:
        """All scalar functionals of the lent state, with one reduction for all."""
        self.require_lent()
        names = list(self.formulation.monitors)
        local = np.array([fem.assemble_scalar(self._form(f"monitor_{n}")) for n in names])
        values = (
            dict(zip(names, self.sum(local).tolist(), strict=True)) | self._maxima() | self._first_levels()
        )
        return values | {name: f(values) for name, f in self.formulation.derived.items()}

    def _maxima(self) -> dict[str, float]:
        """Largest values of expressions, also between nodes, interpolated with two additional degrees."""
        if not self.formulation.maxima:
            return {}
        if self._interpolant is None:
            self._interpolant = Interpolant(self.unknown, self.formulation.maxima, raise_degree=2)
            function = self._interpolant.function
            self._peaks = {name: Peak(function, i) for i, name in enumerate(self.formulation.maxima)}
        self._interpolant.update()
        found = {name: peak() for name, peak in self._peaks.items()}
        if not np.isfinite(list(found.values())).all():
            raise ConvergenceError("the state has stretches at which the law is not defined")
        return found

    def _first_levels(self) -> dict[str, float]:
        """Positions where expressions first reach their levels, by their polynomials on each cell."""
        given = self.formulation
        if not given.levels:
            return {}
        if self._levels is None:
            self._levels = FirstLevels(self.unknown, given.coordinate, given.levels)
        return self._levels()

    def monitor(self, name: str) -> float:
        """One scalar functional."""
        self.require_lent()
        self._require_monitor(name)
        return float(self.sum(fem.assemble_scalar(self._form(f"monitor_{name}"))))

    def monitor_gradient(
        self, name: str, loads: Iterable[str] | None = None
    ) -> tuple[np.ndarray, dict[str, float]]:
        """Derivative of a functional with respect to ``U`` and to each load, or to the loads named."""
        self._require_monitor(name)
        return self.scalar_gradient(f"monitor_{name}", self.formulation.monitors[name], loads)

    def scalar_gradient(
        self, key: str, form: ufl.Form, loads: Iterable[str] | None = None
    ) -> tuple[np.ndarray, dict[str, float]]:
        """Derivative of a scalar form, given by a key, in ``U`` and each load, or in the loads named."""
        names = list(self.load_names if loads is None else loads)
        gradient = f"gradient_{key}"
        if gradient not in self._ufl:
            self._ufl[gradient] = ufl.derivative(form, self.unknown, self.test)
            rates = (self._rate_of_scalar(key, form, name) for name in names)
            parts = (self._ufl[part] for part in dict.fromkeys([gradient, *rates]))
            compile_together(self.comm, [part for part in parts if part.integrals()])
        return self._vector(gradient), self._scalar_derivatives(key, form, names)

    def _rate_of_scalar(self, key: str, form: ufl.Form, load: str) -> str:
        """Name of ``∂/∂λ`` of a scalar form; it aims at that load."""
        name = f"{key}_d_{self._aim(load)}"
        if name not in self._ufl:
            self._ufl[name] = _rate(form, self.formulation.loads[load][1])
        return name

    def _scalar_derivatives(self, key: str, form: ufl.Form, loads: Iterable[str]) -> dict[str, float]:
        """``∂/∂λ`` of a scalar form for the loads named; zero for a load that is absent."""
        out = {}
        for load in loads:
            name = self._rate_of_scalar(key, form, load)
            empty = not self._ufl[name].integrals()
            out[load] = 0.0 if empty else float(self.sum(fem.assemble_scalar(self._form(name))))
        return out

    def quadratic_gradient(
        self, phi: np.ndarray, loads: Iterable[str] | None = None
    ) -> tuple[np.ndarray, dict[str, float]]:
        r"""Gradient of ``φᵀ K φ`` in ``U`` and in the loads named, for fixed ``φ``: the third variation."""
        return self.scalar_gradient("quadratic", self._quadratic(phi), loads)

    def quartic(self, phi: np.ndarray) -> float:
        """Fourth variation of the potential, in the one direction ``φ``."""
        quadratic = self._quadratic(phi)
        if "quartic" not in self._ufl:
            rate = ufl.derivative(quadratic, self.unknown, self._phi)
            self._ufl["quartic"] = ufl.derivative(rate, self.unknown, self._phi)
        return float(self.sum(fem.assemble_scalar(self._form("quartic"))))

    def _quadratic(self, phi: np.ndarray) -> ufl.Form:
        """``φᵀ K φ`` as a functional of the state, with the values of ``φ`` written into it."""
        if "quadratic" not in self._ufl:
            self._ufl["quadratic"] = ufl.action(ufl.action(self._ufl["tangent"], self._phi), self._phi)
        self._phi.x.array[: self.size] = phi
        self._phi.x.scatter_forward()
        return self._ufl["quadratic"]

    def force_size(self) -> float:
        r"""Size of the nodal forces before they balance, :math:`\| \sum_j |K_{ij}| \, |U_i| \|`.

        It uses the tangent as last assembled. A residual of pure round-off is about ``4e-17`` of this size,
        on any mesh and under any load. Each rank needs only its own rows.
        """
        self.require_lent()
        starts, _columns, values = self.matrix.getValuesCSR()
        rows = np.add.reduceat(np.append(np.abs(values), 0.0), starts[:-1]) * (np.diff(starts) > 0)
        rows[self.bc_dofs] = 0.0
        forces = rows * np.maximum(np.abs(self._owned), SMALL_DISPLACEMENT)
        return float(np.sqrt(self.dot(forces, forces)))

    def least_force_size(self) -> float:
        r"""A lower bound of :meth:`force_size` from the diagonal alone, :math:`\| |K_{ii}| \, |U_i| \|`.

        It takes no copy of the matrix.
        """
        self.require_lent()
        diagonal = np.abs(self.matrix.getDiagonal().array_r)
        forces = diagonal * np.maximum(np.abs(self._owned), SMALL_DISPLACEMENT)
        forces[self.bc_dofs] = 0.0
        return float(np.sqrt(self.dot(forces, forces)))

    # -- algebra over ranks ------------------------------------------------------------------

    def sum(self, local: np.ndarray | float) -> np.ndarray | float:
        """Sum over ranks."""
        return local if self._alone else self.comm.allreduce(local, op=MPI.SUM)

    def dot(self, a: np.ndarray, b: np.ndarray) -> float:
        """Euclidean inner product over all ranks."""
        local = float(a.dot(b))
        return local if self._alone else self.comm.allreduce(local, op=MPI.SUM)

    def mass_times(self, u: np.ndarray) -> np.ndarray:
        """``M u``; this makes the norm of a field independent of the mesh."""
        return self.multiply(self.mass, u)

    def multiply(self, matrix: PETSc.Mat, u: np.ndarray) -> np.ndarray:
        """``matrix @ u`` for owned arrays."""
        return self.act(matrix.mult, u)

    def act(self, operation: Callable[[PETSc.Vec, PETSc.Vec], None], u: np.ndarray) -> np.ndarray:
        """Apply an operation on PETSc vectors, such as a matrix's ``mult`` or ``solve``, to an array."""
        (x, given), (y, found) = self._work
        given[:] = u
        operation(x, y)
        return found.copy()

    def _require_monitor(self, name: str) -> None:
        if name not in self.formulation.monitors:
            known = ", ".join(self.formulation.monitors)
            raise InputError(f"cannot control {name!r}: the functionals of this problem are {known}")


def _rate(form: ufl.Form, variable: Variable) -> ufl.Form:
    """``∂/∂λ`` of a form, without integrals if it is zero."""
    parts = (integral.integrand() for integral in form.integrals())
    if any(variable.label() in traverse_unique_terminals(part) for part in parts):
        rate = ufl.diff(form, variable)
        if not _is_zero(rate):
            return rate
    return ufl.Form([])


def _is_zero(form: ufl.Form) -> bool:
    """Whether a form is zero when its derivatives are expanded: once for the same form on all meshes."""
    name = form.signature()
    if name not in _zero:
        _zero[name] = not ufl.algorithms.expand_derivatives(form).integrals()
    return _zero[name]
