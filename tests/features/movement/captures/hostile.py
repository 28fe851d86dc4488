"""Tasks that a file could make of the process that reads it."""

import os
import time


def never_end() -> bytes:
    """Compute for ever."""
    while True:
        time.sleep(0.01)


def fill_the_memory() -> bytes:
    """Take as much as there is."""
    taken = []
    while True:
        taken.append(bytearray(2**26))


def die() -> bytes:
    """What a crash in compiled code looks like."""
    os._exit(1)


def fail() -> bytes:
    """A mistake of ours."""
    raise KeyError("no such thing")


def answer() -> bytes:
    """What usually happens."""
    return b"done"
