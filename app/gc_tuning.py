"""When Python looks for garbage: seldom while a program starts, and not once more as it ends.

A start makes half a million objects, none of which is garbage. Python looks through them again and
again as they become more, and a last time when it ends, which together took longer than the
imports themselves: 2.8 s instead of 1.6 s for the server's.
"""

import atexit
import gc

_AS_PYTHON_HAS_IT = gc.get_threshold()
_WHILE_STARTING = (100_000, 50, 1000)


def relax_gc() -> None:
    """Look seldom from now on, and do not look when the process ends; for the main module."""
    gc.set_threshold(*_WHILE_STARTING)
    atexit.register(gc.freeze)


def freeze_startup_objects() -> None:
    """What is here by now is here to stay and need not be looked at; look as usual at what comes.

    To look through a whole server took 0.2 s now and then, in which nothing was acknowledged.
    """
    gc.collect()
    gc.freeze()
    gc.set_threshold(*_AS_PYTHON_HAS_IT)
