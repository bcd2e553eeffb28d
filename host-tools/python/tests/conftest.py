"""What holds for every test."""

import signal

# A program that a shell starts in the background ignores Ctrl-C, and Python leaves it so: the tests of Ctrl-C would wait for nothing.
signal.signal(signal.SIGINT, signal.default_int_handler)
