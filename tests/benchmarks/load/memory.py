"""Measure whether the server's memory keeps growing while a lab works."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from tests.benchmarks.load.plans import Load
from tests.benchmarks.load.scenario import run_load
from tests.benchmarks.report import Figure

LAB = {"sessions": 6, "real": 1, "consoles": 4}
WARM_UP_SHARE = 1 / 3
LIMIT_MIB_PER_H = 10.0


def memory_figures(part: str, folder: Path, duration_s: float) -> Iterator[Figure]:
    """Have six sessions stream to SQLite with four consoles open, and follow the server's memory.

    Its caches fill in the first third, which does not count. The limit is for an hour: in less
    time, caches that still fill look like growth.
    """
    watch = run_load(folder, Load(duration_s=duration_s, **LAB)).watch
    warm_up_s = WARM_UP_SHARE * duration_s
    memory_mib = watch.rss_mib()
    at_s = np.array([look.at_s for look in watch.looks]) - watch.looks[0].at_s
    for name, share in (
        ("after a tenth", 0.1),
        ("after a third", WARM_UP_SHARE),
        ("at the end", 1),
    ):
        near = memory_mib[at_s <= share * at_s[-1]][-5:]
        yield Figure(
            part, f"server {name} of {duration_s / 60:g} min", float(np.median(near)), "MiB"
        )
    slope = watch.rss_slope_mib_per_h(warm_up_s)
    yield Figure(part, "server grows by", slope, "MiB/h", "limit", LIMIT_MIB_PER_H)
