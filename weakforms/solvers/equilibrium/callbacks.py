"""What Python raises while PETSc calls it waits until PETSc has returned."""

from __future__ import annotations

from collections.abc import Callable


class Deferred:
    """Runs the callbacks of one PETSc object, and keeps the first error that one of them raises.

    An exception must not pass through PETSc's C frames: vectors stay locked, objects cannot be destroyed, and
    petsc4py 3.22 may end the process in its own error handler (a segmentation fault in ``PyTraceBack_Here``).
    So a callback that fails spoils its result, by which PETSc ends soon, and the error is raised after that.
    """

    def __init__(self) -> None:
        self.error: BaseException | None = None

    def run(self, work: Callable[[], None], spoil: Callable[[], None]) -> None:
        """Do the work, or spoil its result if that raises or anything before it did.

        Args:
            work: What PETSc calls for.
            spoil: Leaves a result with which PETSc comes to an end.
        """
        if self.error is None:
            try:
                work()
                return
            except BaseException as error:  # also an interrupt
                self.error = error
        spoil()

    def release(self) -> None:
        """Raise what is kept, if anything is; nothing is kept afterwards."""
        error, self.error = self.error, None
        if error is not None:
            raise error
