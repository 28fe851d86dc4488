"""A quality watch without a server, which receives batches of a moving body at chosen times."""

from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from typing import Any

import numpy as np

from app.features.record.alarms.alarm import Change, Moment, WatchLimits
from app.features.record.alarms.watch import CheckResult, QualityWatch
from app.wire import BODY_STREAMS, Batch, StreamName, decode_batch, encode_batch
from app.wire.messages import HeadsetState, PhaseOrder, Welcome
from tests.science.stream_quality.recordings import Recording, generated, jitter

BEGAN = datetime(2026, 3, 2, 9, 30, tzinfo=UTC)
PER_BATCH = 9
TREMBLING = jitter(generated(1), np.random.default_rng(5))


def at(seconds: float) -> Moment:
    """Return the moment this many seconds after the beginning."""
    return Moment(1000.0 + seconds, BEGAN + timedelta(seconds=seconds))


def order(phase_id: int = 1, status: str = "running") -> PhaseOrder:
    """Return a phase in progress as the headset receives it."""
    return PhaseOrder(
        phase_id=phase_id,
        kind="task",
        limb="hand",
        status=status,
        latency_ms=0.0,
        preparation_s=5.0,
        duration_s=60.0,
        freeze_s=5.0,
        active_s=0.0,
        completions=0,
        pausing=False,
        resuming=False,
    )


def state(*, recording: bool = True, phase: PhaseOrder | None = None) -> HeadsetState:
    """Return a session state as the headset receives it."""
    return HeadsetState(
        version=1,
        status="active",
        step_index=7,
        step_kind="task",
        materialised=recording,
        recording=recording,
        phase=phase,
        participant={"handedness": "right", "footedness": "right", "stature_m": 1.75},
    )


def welcome(time_scale: float = 1.0, **fields: Any) -> Welcome:
    """Return the server's first message to the headset."""
    values: dict[str, Any] = {
        "protocol": 1,
        "session_id": "s",
        "epoch": 1,
        "time_scale": time_scale,
        "language": "en",
        "avatar": "delayed_copy",
        "on_disconnect": "pause",
        "undelayed_parts": ("Hips",),
        "tasks": {},
        "texts": {},
        "positions": (),
        "state": state(),
        **fields,
    }
    return Welcome(**values)


def batch(
    recording: Recording,
    first: int,
    count: int = PER_BATCH,
    *,
    stream: StreamName = StreamName.TARGET,
    epoch: int = 1,
    seq_first: int | None = None,
    phase_id: int = 1,
) -> Batch:
    """Return frames of a recording as a batch that was encoded and decoded."""
    part = recording.part(slice(first, first + count))
    values = np.concatenate((part.positions_m, part.rotations.reshape(count, -1)), axis=1)
    return decode_batch(
        encode_batch(
            stream,
            epoch=epoch,
            phase_id=phase_id,
            seq_first=first if seq_first is None else seq_first,
            times_s=part.times_s,
            flags=np.ones(count, np.uint8),
            values=np.ascontiguousarray(values, np.float32),
            active_s=1.0,
            closed_at_s=1.0,
        )
    )


@dataclass
class Watched:
    """A quality watch with the changes that it reported, in real time or that of a fast client."""

    time_scale: float = 1.0
    limits: WatchLimits = field(default_factory=WatchLimits)
    changes: list[Change] = field(default_factory=list)
    checks: list[tuple[float, CheckResult]] = field(default_factory=list)
    watch: QualityWatch = field(init=False)

    def __post_init__(self) -> None:
        self.watch = QualityWatch.of(welcome(self.time_scale), self.limits, at(0.0))

    @property
    def reported(self) -> list[tuple[str, str]]:
        """Every change as (code, state), in order."""
        return [(change.condition.code, change.state) for change in self.changes]

    def play(self, recording: Recording, *, begin_s: float = 0.0) -> float:
        """Send both streams of a recording, checking at intervals; return the time at its end."""
        now_s, checked_s = begin_s, begin_s
        for first in range(0, len(recording) - PER_BATCH + 1, PER_BATCH):
            now_s = begin_s + float(np.nan_to_num(first / 90.0)) / self.time_scale
            for stream in BODY_STREAMS:
                sent = batch(recording, first, stream=stream)
                self.changes += self.watch.batch(sent, at(now_s))
                self.watch.backlog.acknowledged(at(now_s).monotonic_s, waiting=False)
            while now_s - checked_s >= self.watch.limits.check_every_s:
                checked_s += self.watch.limits.check_every_s
                self.check(checked_s)
        return now_s

    def check(self, now_s: float, *, reading: bool = True) -> CheckResult:
        """Run one check of the watch at a time and store its result."""
        result = self.watch.check(at(now_s), reading=reading)
        self.changes += result.changes
        self.checks.append((now_s, result))
        return result

    def wait(self, begin_s: float, for_s: float) -> float:
        """Run the checks of `for_s` seconds without any message; return the time at the end."""
        step_s = self.watch.limits.check_every_s
        for turn in range(1, round(for_s / step_s) + 1):
            self.check(begin_s + turn * step_s)
        return begin_s + for_s


def there_and_back(recording: Recording) -> Recording:
    """Return a recording of twice the length, in which the body then moves back the same way."""
    length_s = len(recording) / 90.0
    return Recording(
        np.concatenate((recording.times_s, recording.times_s + length_s)),
        np.concatenate((recording.rotations, recording.rotations[::-1])),
        np.concatenate((recording.positions_m, recording.positions_m[::-1])),
    )
