"""Measure whether the memory of the server and the cockpit's page grows during streaming.

The server's memory is the resident size reported by the system, including its helper processes; the
page's is the size that remains after a forced collection. A slope is the median over all pairs of
samples after a warm-up.
"""

import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
from scipy import stats

from tests.benchmarks.load.watch import HOUR_S, MIB, Watch
from tests.benchmarks.report import Figure
from tests.benchmarks.session_desk.watched import watched_session
from tests.e2e.telemetry_bench import Meter
from tests.support.browser import launched_browser

PART = "memory"
LOOKS = 60
WARM_UP_SHARE = 0.2


def figures(folder: Path, duration_s: float) -> Iterator[Figure]:
    """Measure both while the session streams for the given time."""
    heap: list[tuple[float, int]] = []
    with (
        launched_browser() as browser,
        watched_session(folder, browser, duration_s) as watched,
        Watch(watched.server.pid, watched.server.data_dir / "reembody.sqlite") as watch,
    ):
        meter = Meter.of(watched.page)
        began_s = time.monotonic()
        for look in range(LOOKS):
            due_s = began_s + (look + 1) * (duration_s - 2.0) / LOOKS
            watched.page.wait_for_timeout(1000.0 * max(0.0, due_s - time.monotonic()))
            heap.append((time.monotonic() - began_s, meter.heap_bytes()))
        watched.sender.join()
    warm_up_s = WARM_UP_SHARE * duration_s
    rss_mib = watch.rss_mib()
    times_s = np.array([look.at_s for look in watch.looks]) - watch.looks[0].at_s
    after = float(np.median(rss_mib[times_s >= warm_up_s][:5]))
    what = f"{duration_s / 60:g} min"
    yield Figure(PART, f"server after the warm-up, {what}", after, "MiB")
    yield Figure(PART, "server at the end", float(np.median(rss_mib[-5:])), "MiB")
    slope = watch.rss_slope_mib_per_h(warm_up_s)
    yield Figure(PART, "server grows by", slope, "MiB/h")
    yield from _heap(heap, warm_up_s)
    yield Figure(PART, "server's processor", 100 * watch.cpu_share(), "% of a core")


def _heap(heap: list[tuple[float, int]], warm_up_s: float) -> Iterator[Figure]:
    times_s = np.array([at_s for at_s, _ in heap])
    sizes_mib = np.array([size for _, size in heap]) / MIB
    late = times_s >= warm_up_s
    fit = stats.theilslopes(sizes_mib[late], times_s[late])
    yield Figure(PART, "page after the warm-up", float(np.median(sizes_mib[late][:5])), "MiB")
    yield Figure(PART, "page at the end", float(np.median(sizes_mib[-5:])), "MiB")
    yield Figure(PART, "page grows by", float(fit[0]) * HOUR_S, "MiB/h")
