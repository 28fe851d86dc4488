"""Find how many sessions the server supports before its acknowledgements are late."""

import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from tests.benchmarks.load.figures import ack_ms, samples_per_s
from tests.benchmarks.load.plans import Load
from tests.benchmarks.load.scenario import Outcome, run_load
from tests.benchmarks.report import Figure

FIRST, STEP, LAST = 50, 25, 400
STEP_S = 20.0
LATE_MS = 1000.0
GENERATOR_LAG_MS = 100.0
"""A generator that is later than this limits the measurement itself."""


@dataclass(frozen=True)
class Step:
    """The measurements for one number of sessions.

    They are the latency of acknowledgements and the generator's delay (both in ms), the throughput,
    and the number of cores that the server used.
    """

    sessions: int
    ack_p99_ms: float
    lag_p99_ms: float
    samples_per_s: float
    cores: float
    lost: int

    @property
    def is_good(self) -> bool:
        """Return whether acknowledgements are in time and nothing is lost."""
        return self.ack_p99_ms <= LATE_MS and self.lost == 0

    @property
    def is_measured(self) -> bool:
        """Return whether the generator kept up, so that delays are the server's."""
        return self.lag_p99_ms <= GENERATOR_LAG_MS


def knee_figures(part: str, folder: Path, duration_s: float) -> Iterator[Figure]:
    """Increase the number of sessions until there are too many, each on a fresh server."""
    steps: list[Step] = []
    for sessions in range(FIRST, LAST + 1, STEP):
        step = _step(sessions, run_load(folder / str(sessions), _load(sessions, duration_s)))
        steps.append(step)
        yield Figure(
            part, f"durable ack p99, {sessions} sessions", step.ack_p99_ms, "ms", "limit", LATE_MS
        )
        yield Figure(part, f"server CPU, {sessions} sessions", 100 * step.cores, "% of a core")
        yield Figure(part, f"generator lag p99, {sessions} sessions", step.lag_p99_ms, "ms")
        if not (step.is_good and step.is_measured):
            break
    yield from _verdict(part, steps)


def _verdict(part: str, steps: list[Step]) -> Iterator[Figure]:
    """Return the last good and the first bad number, and whether server or load was the limit."""
    good = [step for step in steps if step.is_good and step.is_measured]
    if good:
        yield Figure(part, "last good number of sessions", good[-1].sessions, "sessions")
        yield Figure(part, "joint samples at that number", good[-1].samples_per_s, "1/s")
    end = steps[-1]
    if end in good:
        print(f"  {part}: no knee up to {end.sessions} sessions", file=sys.stderr)
    elif end.is_measured:
        yield Figure(part, "first bad number of sessions", end.sessions, "sessions")
    else:
        name = "first bad number of sessions; the generator itself fell behind (shared cores)"
        yield Figure(part, name, end.sessions, "sessions")


def _load(sessions: int, duration_s: float) -> Load:
    """Return a load of lean clients without digests, which leaves the cores to the server."""
    return Load(sessions=sessions, duration_s=duration_s, real=0, consoles=0, digest_every=10**9)


def _step(sessions: int, outcome: Outcome) -> Step:
    return Step(
        sessions,
        ack_p99_ms=float(np.percentile(ack_ms(outcome), 99)),
        lag_p99_ms=max(told["lag_s"]["p99"] for told in outcome.told.values()) * 1000,
        samples_per_s=samples_per_s(outcome),
        cores=outcome.watch.cpu_share(),
        lost=outcome.verdict.lost,
    )
