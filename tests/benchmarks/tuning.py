"""Compare relay tuning with manually set gains and with Ziegler and Nichols.

All three run on the product's own body of 52 parts, every free axis, on two threads. The manual
gains are those shipped with the product: one natural frequency per body part, chosen by people,
times the inertia that each axis moves. Ziegler and Nichols's rule has the same relay experiments as
ours, without an integral part, which an avatar does not have, and without a second attempt, which
the rule does not include.

`steps` lets each axis jump by 30 degrees on the whole body: overshoot (median at most 3 %, worst at
most 10 %), settling to 2 %, total duration (at most 30 s), and the state of the axes. Each value is
that of our tuning; its peers are, in turn, the limit and the two other methods. `tracking` lets the
three bodies follow real people if the shared data are available.
"""

import time
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache
from statistics import median

from app.science.avatar.configuration import Configuration
from app.science.avatar.mjcf import default_configuration
from app.science.avatar.tuning import AxisTuning, TuningOptions, assess, track, tune
from tests.benchmarks.clips import movements
from tests.benchmarks.report import Figure, Report
from tests.science.avatar.captured import STATURE_M

PARTS = ("steps", "tracking")
WORKERS = 2
BY_HAND = "by hand"
LIMITS = {"overshoot, median": 3.0, "overshoot, worst": 10.0, "wall time": 30.0}


@dataclass(frozen=True)
class Contender:
    """One tuning method: the resulting configuration, and its axes' step responses."""

    name: str
    configuration: Configuration
    axes: tuple[AxisTuning, ...]
    wall_s: float

    def figures(self) -> Iterator[tuple[str, float, str]]:
        """Return the name, value and unit of each figure."""
        steps = [one.step for one in self.axes if one.step is not None]
        overshoots = [step.overshoot_percent for step in steps]
        settled = [step.settling_s for step in steps if step.settling_s is not None]
        yield "overshoot, median", median(overshoots), "%"
        yield "overshoot, worst", max(overshoots), "%"
        yield "settling, median", 1e3 * median(settled), "ms"
        yield "settling, worst", 1e3 * max(settled), "ms"
        yield "axes that do not settle", float(len(steps) - len(settled)), "axes"
        yield "steady error, worst", max(abs(step.steady_error_deg) for step in steps), "deg"
        yield "wall time", self.wall_s, "s"
        yield "axes accepted", float(self._count("tuned", "retried", "accepted")), "axes"
        yield "axes flagged with a reason", float(self._count("flagged")), "axes"
        yield "axes without an answer", float(self._count("")), "axes"

    def _count(self, *words: str) -> int:
        return sum(one.status.partition(":")[0] in words for one in self.axes)


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts; their duration cannot be chosen."""
    report = Report("tuning")
    if "steps" in parts:
        report.add(*_steps())
    if "tracking" in parts:
        report.add(*_tracking())
    return report


@cache
def _contenders() -> tuple[Contender, ...]:
    def tuned(name: str, options: TuningOptions) -> Contender:
        found = tune(default_configuration(), STATURE_M, options, wall_s=time.monotonic)
        return Contender(name, found.configuration, found.axes, found.wall_s)

    by_hand = assess(default_configuration(), STATURE_M, wall_s=time.monotonic)
    return (
        tuned("relay tuning", TuningOptions(workers=WORKERS)),
        Contender(BY_HAND, by_hand.configuration, by_hand.axes, by_hand.wall_s),
        tuned(
            "Ziegler-Nichols",
            TuningOptions(heuristic="ziegler-nichols-pd", attempts=1, workers=WORKERS),
        ),
    )


def _steps() -> Iterator[Figure]:
    ours, *others = _contenders()
    beside: list[tuple[str, Callable[[str], float | None]]] = [("at most", LIMITS.get)]
    beside += [(one.name, _lookup(one)) for one in others]
    for name, value, unit in ours.figures():
        for peer, value_of in beside:
            known = value_of(name)
            # The time that people need to set gains manually is not measured here.
            if known is not None and (peer, name) != (BY_HAND, "wall time"):
                yield Figure("steps", name, value, unit, peer, known)


def _lookup(contender: Contender) -> Callable[[str], float | None]:
    values = {name: value for name, value, _ in contender.figures()}
    return values.get


def _tracking() -> Iterator[Figure]:
    ours, *others = _contenders()
    for clip, movement in movements():
        found = {
            one.name: track(one.configuration, STATURE_M, movement).clamped for one in _contenders()
        }
        for told in ("mean", "p95"):
            value = getattr(found[ours.name], f"{told}_deg")
            for other in others:
                theirs = getattr(found[other.name], f"{told}_deg")
                yield Figure("tracking", f"{clip}, {told}", value, "deg", other.name, theirs)
