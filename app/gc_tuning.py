"""Tune Python's garbage collector: collect rarely during start-up, and not at exit.

Start-up creates half a million objects, none of which is garbage. Python scans them repeatedly as
their number grows, and a last time at exit, which together took longer than the imports themselves:
2.8 s instead of 1.6 s for the server's.
"""

import atexit
import gc
import sys
from collections.abc import Iterator
from contextlib import contextmanager

_AS_PYTHON_HAS_IT = gc.get_threshold()
_WHILE_STARTING = (100_000, 50, 1000)


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


def freeze_startup_objects() -> None:
    """Exclude all existing objects from garbage collection, and restore the usual thresholds.

    Scanning a whole server took 0.2 s now and then, during which nothing was acknowledged.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(*_AS_PYTHON_HAS_IT)
