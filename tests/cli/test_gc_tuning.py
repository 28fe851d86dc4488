"""A test of the tuning of Python's garbage collector."""

import subprocess
import sys

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
