"""When Python looks for garbage."""

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


def test_seldom_while_starting_and_as_usual_from_then_on() -> None:
    """A server that has started collects as Python does, apart from what is here to stay."""
    said = subprocess.run([sys.executable, "-c", TOLD], capture_output=True, check=True, text=True)
    assert said.stdout.split() == ["True", "True", "True"]
