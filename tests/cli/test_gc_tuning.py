"""Tests of the tuning of Python's garbage collector and of the arenas of the C library."""

import platform
import subprocess
import sys

import pytest

TOLD = """
import gc
usual = gc.get_threshold()
from app.cli import main
while_starting = gc.get_threshold()
from app.gc_tuning import freeze_startup_objects, loading_modules
with loading_modules():
    collects_while_loading = gc.isenabled()
print(while_starting[0] > usual[0], collects_while_loading, gc.isenabled())
freeze_startup_objects()
print(gc.get_threshold() == usual, gc.get_freeze_count() > 1000)
"""


def test_gc_is_relaxed_while_starting_only() -> None:
    """Garbage is collected rarely while starting, never while loading, and then as usual."""
    result = subprocess.run(
        [sys.executable, "-c", TOLD], capture_output=True, check=True, text=True
    )
    assert result.stdout.split() == ["True", "False", "True", "True", "True"]


LOADED_LATER = """
import gc
from app.gc_tuning import loading_modules
counts = []
for _ in range(2):
    with loading_modules():
        import decimal
    counts.append(gc.get_freeze_count())
    kept = [[] for _ in range(1000)]
print(counts[0] > 0, counts[1] == counts[0])
"""


def test_modules_loaded_later_are_excluded_once() -> None:
    """Loading a module excludes all objects from collection; doing so again excludes no others."""
    result = subprocess.run(
        [sys.executable, "-c", LOADED_LATER], capture_output=True, check=True, text=True
    )
    assert result.stdout.split() == ["True", "True"]


ARENAS = """
import re, sys, threading
from app.gc_tuning import limit_arenas
if sys.argv[1] == "limited":
    limit_arenas()
released = threading.Event()
kept = []
def allocate():
    kept.append([bytes(100_000) for _ in range(10)])
    released.wait()
threads = [threading.Thread(target=allocate) for _ in range(12)]
for one in threads:
    one.start()
heaps = 0
for line in open("/proc/self/maps"):
    found = re.match(r"([0-9a-f]+)-\\S+ rw-p 00000000 00:00 0 *$", line)
    # An arena of a thread begins at a multiple of 64 MiB.
    heaps += found is not None and int(found[1], 16) % (64 << 20) == 0
released.set()
print(heaps)
"""


@pytest.mark.skipif(platform.libc_ver()[0] != "glibc", reason="only glibc has arenas")
def test_threads_share_two_arenas() -> None:
    """A dozen threads that allocate share glibc's two arenas; otherwise they make more."""
    limited, usual = (
        int(
            subprocess.run(
                [sys.executable, "-c", ARENAS, how], capture_output=True, check=True, text=True
            ).stdout
        )
        for how in ("limited", "usual")
    )
    assert limited < 2 < usual
