"""The state of every source of live tracking: is it regular, complete, and on whose clock.

Everything here is a function of packets and of their arrival, which is an argument: no clock is
read and no socket opened. Times are in seconds; `arrival_s` is by the server's monotonic clock.

A source is one sender at one door: the same name from another address is another source, so that
two senders are never mixed. Memory is bounded whatever is sent.
"""

from collections import Counter, deque
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import pairwise
from statistics import median
from typing import Literal

from app.adapters.live import Pose, Problem, Reading, SkeletonDefinition

DoorKey = Literal["osc", "natnet", "json"]
MAX_SOURCES = 16
"""The most sources at once; one that has been silent makes room for a new one."""
MAX_TRACKERS = 256
"""The most trackers and bones of a source."""
SILENT_S = 2.0
"""Without a packet for so long, a source is silent and may be replaced by a new one."""
FORGOTTEN_S = 600.0
"""A source that was silent for so long is removed."""
RATE_S = 2.0
"""The rate is that of the samples of this time."""
WINDOW_S = 10
"""The clock offset is estimated over this time, in whole seconds."""
RESTART_S = 1.0
"""A source time so far before the newest one means that the source was restarted."""
RESTART_FRAMES = 100
LONGEST_LOSS_FRAMES = 10_000
"""A counter that goes further ahead was set anew; nobody lost so many packets."""
_LATE_IN_A_ROW = 10
_KEPT = 128
_GAP = 3.0  # times the usual interval
_SETTLED = 8  # intervals after which the usual one is known
_JITTER_SHARE = 0.95


@dataclass(frozen=True, slots=True)
class Sample:
    """The poses of a packet with its source and its time.

    `door` is `headset` for where a headset says that its wearer's head is. `source` is the source's
    label, `address` that of the sender. `source_s` is the time by the source's own clock, None if
    it sends none. `mapped_s` is that time on the server's clock, with its uncertainty; without a
    source time it is the arrival. `uncertainty_s` is None without a source time, and while it is
    unknown. `skeletons` are as in `Reading`. `is_late`: a newer packet had come before, so it is
    for the record only.
    """

    door: DoorKey | Literal["headset"]
    source: str
    address: str
    poses: tuple[Pose, ...]
    source_s: float | None
    arrival_s: float
    mapped_s: float
    uncertainty_s: float | None
    skeletons: tuple[SkeletonDefinition, ...] = ()
    is_late: bool = False


class SourceClock:
    """Maps a source's time to the server's, by the least delayed packets.

    Packets are never early, so the smallest difference of arrival and source time in a window is
    the nearest to the clock offset (the minimum filter of NTP, RFC 5905 section 10, for one
    direction). The smallest differences of single seconds vary by queueing and by the drift of
    either clock; their range is the uncertainty. The shortest path's own delay, typically below a
    millisecond by cable, remains in the offset: one-way messages cannot reveal it.
    """

    def __init__(self) -> None:
        self._smallest: deque[tuple[int, float]] = deque(maxlen=WINDOW_S)

    def note(self, time_s: float, arrival_s: float) -> None:
        """Take the times of one packet."""
        second, difference = int(arrival_s), arrival_s - time_s
        if self._smallest and self._smallest[-1][0] == second:
            difference = min(difference, self._smallest.pop()[1])
        self._smallest.append((second, difference))
        while self._smallest[0][0] <= second - WINDOW_S:
            self._smallest.popleft()

    @property
    def offset_s(self) -> float | None:
        """What is added to a source time to map it; None before the first packet."""
        return min((one for _, one in self._smallest), default=None)

    @property
    def uncertainty_s(self) -> float | None:
        """The range of the seconds' smallest differences; None before three seconds are over."""
        smallest = [one for _, one in self._smallest][:-1]
        return max(smallest) - min(smallest) if len(smallest) > 2 else None


class Tracker:
    """One tracker or bone of a source: its newest pose, and how regularly samples arrive."""

    def __init__(self) -> None:
        self.pose: Pose | None = None
        self.samples = 0
        self.gaps = 0
        self.longest_gap_s = 0.0
        self.last_s = 0.0
        self._arrivals: deque[float] = deque(maxlen=_KEPT)
        self._usual_s: float | None = None

    def note(self, pose: Pose, arrival_s: float) -> None:
        """Take a pose; a rotation that follows a position alone is not another sample (VRChat)."""
        completes = (
            pose.position_m is None and self.pose is not None and self.pose.position_m is not None
        )
        self.last_s = arrival_s
        if completes:
            return
        self.pose = pose
        if self._arrivals and self._usual_s is not None:
            interval = arrival_s - self._arrivals[-1]
            if interval > _GAP * self._usual_s:
                self.gaps += 1
                self.longest_gap_s = max(self.longest_gap_s, interval)
        self.samples += 1
        self._arrivals.append(arrival_s)
        if self.samples % _SETTLED == 0:
            self._usual_s = median(self._intervals())

    def rate_hz(self, now_s: float) -> float | None:
        """Return the samples per second of late; None if there are too few."""
        recent = [one for one in self._arrivals if one > now_s - RATE_S]
        if len(recent) < 2 or recent[-1] <= recent[0]:
            return None
        return (len(recent) - 1) / (recent[-1] - recent[0])

    @property
    def jitter_s(self) -> float | None:
        """How far 95 % of the last intervals are from the usual one at most, gaps left out."""
        if self._usual_s is None:
            return None
        usual = self._usual_s
        off = sorted(abs(one - usual) for one in self._intervals() if one <= _GAP * usual)
        return off[int(_JITTER_SHARE * (len(off) - 1))] if off else None

    def _intervals(self) -> list[float]:
        arrivals = list(self._arrivals)
        return [after - before for before, after in pairwise(arrivals)]


@dataclass(frozen=True)
class SourceKey:
    """What tells sources apart: the door, the sender's address with its port, and the name."""

    door: DoorKey
    address: str
    name: str


@dataclass
class Source:
    """A source: its trackers, its clock, and what was wrong with its packets.

    `doubled`, `late` and `skipped` count packets that came twice, after a newer one, or never, by
    the source's own counter or time; `ordered` is False if it has neither, so that nobody can know.
    """

    key: SourceKey
    first_s: float
    last_s: float
    packets: int = 0
    ordered: bool = False
    doubled: int = 0
    late: int = 0
    skipped: int = 0
    restarts: int = 0
    problems: Counter[Problem] = field(default_factory=Counter)
    trackers: dict[str, Tracker] = field(default_factory=dict)
    clock: SourceClock = field(default_factory=SourceClock)
    latest: Sample | None = None
    _frame: int | None = None
    _time_s: float | None = None
    _at_time: set[str] = field(default_factory=set)
    _late_in_a_row: int = 0

    @property
    def label(self) -> str:
        """The name that people see: the source's own, else the machine that it runs on."""
        return self.key.name or self.key.address.rpartition(":")[0]

    def gave_way_to(self, key: SourceKey, now_s: float) -> bool:
        """Whether this one is silent, and `key` the same software, started anew at another port."""
        host, own = (one.address.rpartition(":")[0] for one in (key, self.key))
        same = (key.door, key.name, host) == (self.key.door, self.key.name, own)
        return same and now_s - self.last_s > SILENT_S

    def note(self, reading: Reading, arrival_s: float) -> Sample | None:
        """Take a packet; return its sample, or None if it has none or was doubled."""
        self.packets += 1
        self.last_s = arrival_s
        self.problems += reading.problems
        late = self.late
        if not self._in_order(reading):
            is_late = self.late > late and bool(reading.poses)
            return self._sample(reading, arrival_s, is_late=True) if is_late else None
        if reading.time_s is not None:
            self.clock.note(reading.time_s, arrival_s)
        if not reading.poses:
            return None
        for pose in reading.poses:
            tracker = self.trackers.get(pose.tracker)
            if tracker is None:
                if len(self.trackers) >= MAX_TRACKERS:
                    self.problems["limit"] += 1
                    continue
                tracker = self.trackers[pose.tracker] = Tracker()
            tracker.note(pose, arrival_s)
        self.latest = self._sample(reading, arrival_s)
        return self.latest

    def _sample(self, reading: Reading, arrival_s: float, *, is_late: bool = False) -> Sample:
        offset = self.clock.offset_s
        is_timed = reading.time_s is not None and offset is not None
        return Sample(
            door=self.key.door,
            source=self.label,
            address=self.key.address,
            poses=reading.poses,
            source_s=reading.time_s,
            arrival_s=arrival_s,
            mapped_s=(reading.time_s or 0.0) + (offset or 0.0) if is_timed else arrival_s,
            uncertainty_s=self.clock.uncertainty_s if is_timed else None,
            skeletons=reading.skeletons,
            is_late=is_late,
        )

    def _in_order(self, reading: Reading) -> bool:
        """Count a packet that is not the next one; return whether its poses are new."""
        if reading.frame is None and reading.time_s is None:
            return True
        self.ordered = True
        if self._restarted(reading):
            self.restarts += 1
            self.clock = SourceClock()
            self._start(reading)
            return True
        if self._doubled(reading):
            self.doubled += 1
            return False
        if self._is_late(reading):
            self.late += 1
            self._late_in_a_row += 1
            return False
        if reading.frame is not None and self._frame is not None:
            self.skipped += reading.frame - self._frame - 1
        self._start(reading)
        return True

    def _start(self, reading: Reading) -> None:
        """Take a packet's counter and time as the newest."""
        if reading.time_s != self._time_s:
            self._at_time = set()
        self._at_time |= {one.tracker for one in reading.poses}
        self._frame = reading.frame if reading.frame is not None else self._frame
        self._time_s = reading.time_s if reading.time_s is not None else self._time_s
        self._late_in_a_row = 0

    def _restarted(self, reading: Reading) -> bool:
        step_back = _step_back(self._frame, reading.frame)
        counts_anew = step_back > RESTART_FRAMES or step_back < -LONGEST_LOSS_FRAMES
        back_s = _step_back(self._time_s, reading.time_s) > RESTART_S
        return counts_anew or back_s or self._late_in_a_row >= _LATE_IN_A_ROW

    def _doubled(self, reading: Reading) -> bool:
        if reading.frame is not None and self._frame is not None:
            return reading.frame == self._frame
        # Without a counter, a frame may come in several packets, but each tracker in one of them.
        return reading.time_s == self._time_s and any(
            one.tracker in self._at_time for one in reading.poses
        )

    def _is_late(self, reading: Reading) -> bool:
        if reading.frame is not None and self._frame is not None:
            return reading.frame < self._frame
        return _step_back(self._time_s, reading.time_s) > 0


def _step_back(newest: float | None, given: float | None) -> float:
    return 0.0 if newest is None or given is None else newest - given


class Sources:
    """All sources of all doors. Not for several threads at once."""

    def __init__(self) -> None:
        self._by_key: dict[SourceKey, Source] = {}
        self.turned_away: Counter[DoorKey] = Counter()
        """Packets of new sources for which there was no room, by door."""

    def note(
        self, door: DoorKey, address: str, reading: Reading, arrival_s: float
    ) -> Sample | None:
        """Take a packet that came from `address` through a door; return its sample, if any."""
        source = self._source(SourceKey(door, address, reading.source), reading, arrival_s)
        if source is None:
            self.turned_away[door] += 1
            return None
        return source.note(reading, arrival_s)

    def all(self, now_s: float) -> Iterator[Source]:
        """Yield the sources in the order in which they appeared, without forgotten ones."""
        for source in list(self._by_key.values()):
            if now_s - source.last_s > FORGOTTEN_S:
                del self._by_key[source.key]
            else:
                yield source

    def forget(self, door: DoorKey) -> None:
        """Remove the sources of a door, which was closed."""
        self._by_key = {key: one for key, one in self._by_key.items() if key.door != door}
        del self.turned_away[door]

    def _source(self, key: SourceKey, reading: Reading, arrival_s: float) -> Source | None:
        found = self._by_key.get(key)
        if found is None and not reading.poses:
            # A damaged packet has no name: it belongs to the sender at its address.
            found = next((one for one in self._by_key.values() if _same_sender(one, key)), None)
        if found is None:
            restarts = self._make_way(key, arrival_s)
            if self._has_room(arrival_s):
                found = self._by_key[key] = Source(key, arrival_s, arrival_s, restarts=restarts)
        return found

    def _make_way(self, key: SourceKey, now_s: float) -> int:
        """Remove the silent source that was restarted as `key`; return its count of restarts."""
        for one in list(self._by_key.values()):
            if one.gave_way_to(key, now_s):
                del self._by_key[one.key]
                return one.restarts + 1
        return 0

    def _has_room(self, arrival_s: float) -> bool:
        if len(self._by_key) < MAX_SOURCES:
            return True
        oldest = min(self._by_key.values(), key=lambda one: one.last_s)
        if arrival_s - oldest.last_s <= SILENT_S:
            return False
        del self._by_key[oldest.key]
        return True


def _same_sender(source: Source, key: SourceKey) -> bool:
    return (source.key.door, source.key.address) == (key.door, key.address)
