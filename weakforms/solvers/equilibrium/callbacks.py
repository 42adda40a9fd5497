"""Exceptions in Python functions that PETSc calls are kept until PETSc has returned."""

from __future__ import annotations

from collections.abc import Callable


class Deferred:
    """Runs the callbacks of one PETSc object, and keeps the first error that one of them raises.

    An exception must not pass through PETSc's C frames: vectors stay locked, objects cannot be destroyed, and
    petsc4py 3.22 may end the process in its own error handler (a segmentation fault in ``PyTraceBack_Here``).
    A callback that fails therefore makes its result invalid, so that PETSc stops soon. The error is raised
    after that.
    """

    def __init__(self) -> None:
        self.error: BaseException | None = None

    def run(self, work: Callable[[], None], spoil: Callable[[], None]) -> None:
        """Do the work; if it raises an exception, or an earlier call did, make the result invalid.

        Args:
            work: The work of the callback.
            spoil: Writes an invalid result, with which PETSc stops.
        """
        if self.error is None:
            try:
                work()
                return
            except BaseException as error:  # also an interrupt
                self.error = error
        spoil()

    def release(self) -> None:
        """Raise and forget the kept exception, if there is one."""
        error, self.error = self.error, None
        if error is not None:
            raise error
