"""Monitor the quality of one stream of one epoch, about a second of frames at a time."""

from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from app.features.record.alarms.alarm import Condition, WatchLimits
from app.science.skeleton import JOINT_COUNT, JOINT_NAMES
from app.science.stream_quality import Examination, Memory, examine
from app.wire import Batch, StreamName

FRAMES_AT_ONCE = 90
CLIENT_S_AT_ONCE = 1.0
RATES_TO_LEARN = 3
JOINTS_NAMED = 4
INTERVALS_OF_PACE = 5
SLOW_INTERVALS = 4
"""So many of the last intervals tell a slow device from one that stumbled once."""


@dataclass
class StreamTally:
    """Counts of a stream's faults since the phase began."""

    phase_id: int = 0
    gaps: int = 0
    gap_s: float = 0.0
    flagged: int = 0


@dataclass
class StreamWatch:
    """Examines the frames of a stream as they arrive, without using the database.

    The usual frame rate is learned: the highest one that lasted for a few seconds. All times are on
    the client's clock, so a client that runs faster than real time is treated like any other.
    """

    stream: StreamName
    limits: WatchLimits
    next_seq: int = 0
    usual_s: float | None = None
    tally: StreamTally = field(default_factory=StreamTally)
    _memory: Memory = field(default_factory=Memory)
    _times: list[NDArray[np.float64]] = field(default_factory=list)
    _values: list[NDArray[np.float32]] = field(default_factory=list)
    _frames: int = 0
    _medians_s: deque[float] = field(default_factory=lambda: deque(maxlen=5))
    _pace: deque[tuple[int, float]] = field(default_factory=deque)
    _intervals_s: deque[float] = field(default_factory=lambda: deque(maxlen=INTERVALS_OF_PACE))

    def take(self, batch: Batch) -> Iterator[Condition]:
        """Add a batch; once there are enough frames to examine, yield the conditions found."""
        header = batch.header
        skip = self.next_seq - header.seq_first
        if skip < 0 or skip >= header.frame_count:
            return  # a batch before it is missing and will be resent, or this one is a duplicate
        if header.phase_id != self.tally.phase_id:
            yield from self._judge()
            self._begin_phase(header.phase_id)
        self.next_seq = header.seq_end
        self._times.append(batch.times_s[skip:])
        self._values.append(batch.values[skip:])
        self._frames += header.frame_count - skip
        spans_s = float(batch.times_s[-1]) - float(self._times[0][0])
        if self._frames >= FRAMES_AT_ONCE or spans_s >= CLIENT_S_AT_ONCE:
            yield from self._judge()

    def _begin_phase(self, phase_id: int) -> None:
        self.tally = StreamTally(phase_id)
        if self.stream is StreamName.ACTUAL:
            # The delay changes between phases, so the avatar may be elsewhere.
            self._memory = self._memory.without_pose()

    @property
    def frame_rate_hz(self) -> float | None:
        """Return the recent frame rate on the client's clock, without long gaps."""
        spans_s = sum(span_s for _, span_s in self._pace)
        return sum(frames for frames, _ in self._pace) / spans_s if spans_s > 0.0 else None

    def _judge(self) -> Iterator[Condition]:
        """Examine the frames collected so far, and yield the conditions found."""
        if not self._frames:
            return
        times_s = np.concatenate(self._times)
        values = np.concatenate(self._values)
        self._times, self._values, self._frames = [], [], 0
        found = examine(
            times_s,
            values[:, 3:].reshape(len(values), JOINT_COUNT, 4),
            values[:, :3],
            limits=self.limits.quality,
            usual_s=self.usual_s,
            before=self._memory,
        )
        self._memory = found.after
        self._learn_rate(found)
        yield from self._conditions(times_s, found)

    def _learn_rate(self, found: Examination) -> None:
        interval_s = found.pacing.interval_s
        forward_s = interval_s[interval_s > 0.0]
        if not len(forward_s):
            return
        self._intervals_s.extend(forward_s.tolist())
        short_s = forward_s[forward_s < self.limits.gap_client_s]
        self._pace.append((len(short_s), float(short_s.sum())))
        while sum(span_s for _, span_s in self._pace) - self._pace[0][1] >= (
            self.limits.low_rate_client_s
        ):
            self._pace.popleft()
        self._medians_s.append(_middle(np.sort(forward_s)))
        if len(self._medians_s) >= RATES_TO_LEARN:
            lasting_s = _middle(sorted(self._medians_s))
            self.usual_s = lasting_s if self.usual_s is None else min(self.usual_s, lasting_s)

    def _conditions(self, times_s: NDArray[np.float64], found: Examination) -> Iterator[Condition]:
        yield from self._bad_values(times_s, found)
        # Where every frame comes so late, each is a gap, and the device is their one cause.
        slow_hz = self._slow_hz()
        gaps = list(self._gap(times_s, found))
        yield from gaps if slow_hz is None else self._too_slow(times_s, slow_hz)
        yield from self._jump(times_s, found)
        yield from self._frozen(times_s, found)
        yield from self._low_rate(times_s)

    def _bad_values(self, times_s: NDArray[np.float64], found: Examination) -> Iterator[Condition]:
        bad = found.non_finite | found.non_unit
        count = int(bad.sum())
        if count == 0:
            return
        self.tally.flagged += count
        what = "no number or no place in a room" if found.non_finite.any() else "a broken rotation"
        yield self._condition(
            "bad_values",
            f"{count} frame(s) of the {self.stream} stream hold {what}; stored and left out",
            times_s[bad],
            value=count,
        )

    def _gap(self, times_s: NDArray[np.float64], found: Examination) -> Iterator[Condition]:
        gap = found.pacing.gap
        if not gap.any():
            return
        lengths_s = found.pacing.interval_s[gap]
        self.tally.gaps += len(lengths_s)
        self.tally.gap_s += float(lengths_s.sum())
        longest_s = float(lengths_s.max())
        if longest_s >= self.limits.gap_client_s:
            yield self._condition(
                "gap",
                f"The {self.stream} stream has a gap of {longest_s:.2f} s",
                times_s[gap],
                value=round(longest_s, 3),
                unit="s",
            )

    def _slow_hz(self) -> float | None:
        """Return the frames per second if nearly every frame comes too late for the clock."""
        limits = self.limits
        late_s = [
            interval_s
            for interval_s in self._intervals_s
            if limits.asleep_client_s <= interval_s < limits.away_client_s
        ]
        return len(late_s) / sum(late_s) if len(late_s) >= SLOW_INTERVALS else None

    def _too_slow(self, times_s: NDArray[np.float64], rate_hz: float) -> Iterator[Condition]:
        if self.stream is StreamName.TARGET:
            least_hz = 1.0 / self.limits.asleep_client_s
            yield self._condition(
                "too_slow",
                f"The device draws {rate_hz:.1f} pictures a second; the clock needs {least_hz:.0f}",
                times_s,
                value=round(rate_hz, 1),
                unit="Hz",
            )

    def _jump(self, times_s: NDArray[np.float64], found: Examination) -> Iterator[Condition]:
        jumped = found.jumped
        if not jumped.any():
            return
        joints = _names(np.asarray(found.turned.any(axis=0))) or ("Hips",)
        yield self._condition(
            "jump",
            f"The {self.stream} stream jumps at {_listed(joints)}",
            times_s[jumped],
            value=int(jumped.sum()),
            joints=joints,
        )

    def _frozen(self, times_s: NDArray[np.float64], found: Examination) -> Iterator[Condition]:
        joints = _names(found.after.frozen)
        if not joints:
            return
        longest_s = float(found.after.still_s[found.after.frozen].max())
        yield self._condition(
            "frozen",
            f"{_listed(joints)} of the {self.stream} stream frozen for {longest_s:.0f} s",
            times_s,
            value=round(longest_s, 1),
            unit="s",
            joints=joints,
        )

    def _low_rate(self, times_s: NDArray[np.float64]) -> Iterator[Condition]:
        rate_hz = self.frame_rate_hz
        spans_s = sum(span_s for _, span_s in self._pace)
        if self.usual_s is None or rate_hz is None or spans_s < self.limits.low_rate_client_s:
            return
        if rate_hz * self.usual_s < self.limits.low_rate_share:
            yield self._condition(
                "low_frame_rate",
                f"The {self.stream} stream has {rate_hz:.0f} frames a second instead of "
                f"{1.0 / self.usual_s:.0f}",
                times_s,
                value=round(rate_hz, 1),
                unit="Hz",
            )

    def _condition(
        self,
        code: str,
        message: str,
        times_s: NDArray[np.float64],
        *,
        value: float,
        unit: str | None = None,
        joints: tuple[str, ...] = (),
    ) -> Condition:
        timed = times_s[np.abs(times_s) <= self.limits.quality.latest_s]
        client_t_s = float(timed[0]) if len(timed) else None
        return Condition(code, message, self.stream, value, unit, client_t_s, joints)


def _middle(ordered: Sequence[float] | NDArray[np.float64]) -> float:
    """Return the upper median, which is always one of the values.

    For so few values this is faster than NumPy's median.
    """
    return float(ordered[len(ordered) // 2])


def _names(joints: NDArray[np.bool_]) -> tuple[str, ...]:
    return tuple(JOINT_NAMES[joint] for joint in np.flatnonzero(joints))


def _listed(joints: tuple[str, ...]) -> str:
    more = len(joints) - JOINTS_NAMED
    named = ", ".join(joints[:JOINTS_NAMED])
    return f"{named} and {more} more" if more > 0 else named
