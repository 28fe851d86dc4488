"""Tests that a study file that would expand enormously is rejected while it is parsed.

Fault 37 of the matrix. Each bomb is parsed in a process of its own, so that its peak memory is its
own; a parser that expanded them would need gigabytes.
"""

import json
import subprocess
import sys

import pytest

from tests.faults.figures import note

ALIASES = "a0: &a0 [x, x]\n" + "\n".join(
    f"a{n}: &a{n} [{', '.join([f'*a{n - 1}'] * 10)}]" for n in range(1, 30)
)
BOMBS = {
    "aliases that stand for 10^29 values": ALIASES,
    "merge keys": "a: {x: 1}\nb:\n  <<: {x: 1}\n",
    "100,000 brackets": "[" * 100_000,
    "100,000 braces": "{a: " * 60_000,
    "a quarter of a million commas": "[" + "," * 250_000,
    "60,000 values": "a: [" + "1, " * 60_000 + "1]",
    "a file of 64 MiB": "a: '" + "x" * 2**26,
    "200,000 dashes": "- " * 120_000,
}
MAX_CPU_S, MAX_GROWTH_MIB = 5.0, 96.0
"""Far above the measured values and far below the cost of any expansion."""

READ = """
import json, resource, sys
from app.protocol import ConfigError, load_instrument
from app.protocol.editing import Change, edit_text
text = sys.stdin.read()
def usage():
    told = resource.getrusage(resource.RUSAGE_SELF)
    return told.ru_utime + told.ru_stime, told.ru_maxrss / 1024
before = usage()
refused = []
for act in (lambda: load_instrument(text), lambda: edit_text(text, [Change(("a",), "set", 1)])):
    try:
        act()
    except ConfigError as error:
        refused.append([error.problems[-1].line, error.problems[-1].remedy])
after = usage()
print(json.dumps([refused, after[0] - before[0], after[1] - before[1]]))
"""


@pytest.mark.parametrize("name", BOMBS)
def test_a_bomb_is_refused_before_it_grows(name: str) -> None:
    """Loader and editor reject a YAML bomb with line and remedy, in little time and memory."""
    done = subprocess.run(
        [sys.executable, "-c", READ], input=BOMBS[name], capture_output=True, text=True, timeout=120
    )
    assert done.returncode == 0, done.stderr[-2000:]
    refused, cpu_s, growth_mib = json.loads(done.stdout)
    note(37, f"YAML: {name}", "CPU s, memory MiB", f"{cpu_s:.2f}, {growth_mib:.0f}")
    assert len(refused) == 2
    assert all(line >= 1 and remedy for line, remedy in refused)
    assert cpu_s < MAX_CPU_S
    assert growth_mib < MAX_GROWTH_MIB
