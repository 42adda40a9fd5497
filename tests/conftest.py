"""What holds for all tests."""

import os
import signal

# PETSc takes over the signals of a crash when it starts. Started here, before pytest does, it leaves them to
# pytest, which says what Python was doing.
from petsc4py import PETSc  # noqa: F401

# Started in the background, as a job of a build server may be, a process ignores interrupts, and so do its
# children: the tests that interrupt some need them to listen.
signal.signal(signal.SIGINT, signal.default_int_handler)

# Tests call the verbs within their own process and look at what is solved there: one process, unless -j says
# more.
os.environ.setdefault("WEAKFORMS_JOBS", "1")
