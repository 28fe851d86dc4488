"""Sample the server's memory, processor time and files once a second."""

import threading
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Self

import numpy as np
import psutil
from numpy.typing import NDArray
from scipy import stats

EVERY_S = 1.0
MIB = 2.0**20
HOUR_S = 3600.0


@dataclass(frozen=True)
class Look:
    """One sample: time (monotonic s), the server's resident memory, CPU time and file bytes."""

    at_s: float
    rss_bytes: int
    cpu_s: float
    wal_bytes: int


@dataclass
class Watch:
    """A context manager that samples a process and its children while its block runs."""

    pid: int
    database: Path | None
    looks: list[Look] = field(default_factory=list)
    _stop: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None
    _cpu_of_s: dict[int, float] = field(default_factory=dict)

    def __enter__(self) -> Self:
        self.looks.append(self._look())
        self._thread = threading.Thread(target=self._run, name="watch", daemon=True)
        self._thread.start()
        return self

    def __exit__(self, *_error: object) -> None:
        self._stop.set()
        if self._thread is not None:
            self._thread.join()

    def cpu_share(self) -> float:
        """Return the mean number of cores in use between the first and the last sample."""
        first, last = self.looks[0], self.looks[-1]
        return (last.cpu_s - first.cpu_s) / (last.at_s - first.at_s)

    def rss_mib(self) -> NDArray[np.float64]:
        """Return the resident memory at every sample."""
        return np.array([look.rss_bytes for look in self.looks]) / MIB

    def rss_slope_mib_per_h(self, warm_up_s: float) -> float:
        """Return the median slope between all pairs of samples (Theil-Sen) after the warm-up."""
        times_s = np.array([look.at_s for look in self.looks])
        late = times_s >= times_s[0] + warm_up_s
        # More samples than this would cost much time for the same slope.
        step = max(1, int(late.sum()) // 1000)
        fit = stats.theilslopes(self.rss_mib()[late][::step], times_s[late][::step])
        return float(fit[0]) * HOUR_S

    def wal_max_mib(self) -> float:
        """Return the greatest size of SQLite's write-ahead log."""
        return max(look.wal_bytes for look in self.looks) / MIB

    def _run(self) -> None:
        while not self._stop.wait(EVERY_S):
            self.looks.append(self._look())

    def _look(self) -> Look:
        server = psutil.Process(self.pid)
        rss_bytes = 0
        for process in (server, *server.children(recursive=True)):
            try:
                times = process.cpu_times()
                rss_bytes += process.memory_info().rss
            except psutil.NoSuchProcess:
                continue
            self._cpu_of_s[process.pid] = times.user + times.system
        wal = None if self.database is None else Path(f"{self.database}-wal")
        wal_bytes = wal.stat().st_size if wal is not None and wal.exists() else 0
        return Look(time.monotonic(), rss_bytes, sum(self._cpu_of_s.values()), wal_bytes)
