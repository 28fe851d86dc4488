"""Tasks that a hostile file could cause in the process that reads it."""

import os
import time


def never_end() -> bytes:
    """Run without end."""
    while True:
        time.sleep(0.01)


def fill_the_memory() -> bytes:
    """Allocate memory without end."""
    taken = []
    while True:
        taken.append(bytearray(2**26))


def die() -> bytes:
    """End the process, as a crash in compiled code does."""
    os._exit(1)


def fail() -> bytes:
    """Raise an error, as a mistake in our code does."""
    raise KeyError("no such thing")


def answer() -> bytes:
    """Return a normal result."""
    return b"done"
