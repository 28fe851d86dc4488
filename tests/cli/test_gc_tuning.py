"""A test of the tuning of Python's garbage collector."""

import subprocess
import sys

TOLD = """
import gc
usual = gc.get_threshold()
from app.cli import main
while_starting = gc.get_threshold()
from app.gc_tuning import freeze_startup_objects
freeze_startup_objects()
print(while_starting[0] > usual[0], gc.get_threshold() == usual, gc.get_freeze_count() > 1000)
"""


def test_gc_is_relaxed_while_starting_only() -> None:
    """Garbage is collected rarely while starting, then as usual without the startup objects."""
    result = subprocess.run(
        [sys.executable, "-c", TOLD], capture_output=True, check=True, text=True
    )
    assert result.stdout.split() == ["True", "True", "True"]
