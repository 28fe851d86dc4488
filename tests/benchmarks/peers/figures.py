"""Compare the product with its peers: same frames, same machine, one after the other."""

from collections.abc import Iterator
from pathlib import Path

from tests.benchmarks.load.plans import Load
from tests.benchmarks.load.scenario import run_load
from tests.benchmarks.peers.append import append_figures
from tests.benchmarks.peers.json_rows import json_figures
from tests.benchmarks.peers.lsl import lsl_figures
from tests.benchmarks.peers.ours import Ours, killed_figures, ours_of
from tests.benchmarks.report import Figure

SESSIONS = 50
MEASURES_S, KILLED_AFTER_S = 20.0, 10.0


def peer_figures(part: str, folder: Path, duration_s: float) -> Iterator[Figure]:
    """Return figures in which the value is the product's and the peer value the other system's."""
    each_s = min(MEASURES_S, duration_s)
    load = Load(sessions=SESSIONS, duration_s=each_s, real=0, consoles=0)
    ours: Ours = ours_of(run_load(folder / "ours", load))
    yield from append_figures(part, folder / "append", ours, each_s / 2)
    yield from json_figures(part, folder / "json-rows", ours, each_s / 2)
    yield from lsl_figures(part, folder / "lsl", ours, each_s)
    yield from killed_figures(part, folder / "killed", min(KILLED_AFTER_S, duration_s))
