"""Tune how memory is given back: Python's garbage collector, and the C library's arenas.

The collector runs rarely during start-up, and not at exit.

Start-up creates half a million objects, none of which is garbage. Python scans them repeatedly as
their number grows, and a last time at exit, which together took longer than the imports themselves:
2.8 s instead of 1.6 s for the server's.
"""

import atexit
import ctypes
import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager

_AS_PYTHON_HAS_IT = gc.get_threshold()
_WHILE_STARTING = (100_000, 50, 1000)
_M_ARENA_MAX, _ARENAS = -8, 2


def relax_gc() -> None:
    """Collect rarely from now on, and not at exit; to be called by the main module."""
    gc.set_threshold(*_WHILE_STARTING)
    atexit.register(gc.freeze)


@contextmanager
def loading_modules() -> Iterator[None]:
    """Collect nothing while modules are loaded, and exclude their objects from then on.

    Half a million objects stay for as long as the process runs: scanning them took a fifth of the
    server's start, and freed a thousand. Those of pandas, if a request is the first to need it,
    would be scanned during later requests: lists of a thousand sessions took twice as long.
    """
    loaded = len(sys.modules)
    gc.disable()
    try:
        yield
    finally:
        if len(sys.modules) > loaded:
            gc.freeze()
        gc.enable()


def limit_arenas() -> None:
    """Let all threads share two arenas of glibc's `malloc`; other C libraries are left as they are.

    Usually each thread gets an arena of its own, eight for every core, and what is free in one is
    of no use to the others: in an hour of six sessions and four consoles the server grew by 13 MiB,
    with two arenas by 8. Call it before there are threads.
    """
    try:
        ctypes.CDLL(None).mallopt(_M_ARENA_MAX, _ARENAS)
    except (AttributeError, OSError, TypeError):
        return  # not glibc


def freeze_startup_objects() -> None:
    """Exclude all existing objects from garbage collection, and restore the usual thresholds.

    Scanning a whole server took 0.2 s now and then, during which nothing was acknowledged.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(*_AS_PYTHON_HAS_IT)
