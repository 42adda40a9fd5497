"""What holds for all tests."""

import signal

# Started in the background, as a job of a build server may be, a process ignores interrupts, and so do its
# children: the tests that interrupt some need them to listen.
signal.signal(signal.SIGINT, signal.default_int_handler)
