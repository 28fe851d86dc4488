"""The trackers of one session and its headset's own head: their newest poses, and the alignment.

Everything here is a function of samples and of their times, which are arguments: no clock is read
and no socket opened. `server_s` is by the server's monotonic clock, `headset_s` by the headset's,
which the least delayed messages map to each other (`SourceClock`).
"""

import threading
from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Literal, cast

import numpy as np

from app.adapters.live import Pose
from app.features.movement.live import Sample, SourceClock
from app.features.record.lab_trackers.bones import WornBones
from app.features.record.lab_trackers.worker_tasks import WatchStep
from app.science.alignment import WINDOW_S, Watched
from app.science.rotations import FloatArray
from app.wire import GOALS, Goal, HeadPose, Place, TrackerPlaces

Status = Literal["no_reference", "silent", "no_headset", "looking", "aligned", "lost"]
"""Whether the headset gets the trackers, or what is missing.

`no_reference`: no tracker is on the head. `silent`: the source, or the head's tracker, sends
nothing. `no_headset`: the headset does not say where it is. `looking`: the wearer has to look
around. `lost`: the headset's world has jumped, and the alignment is fitted again.
"""
REFERENCE = "Head"
"""The limb of the tracker that is fixed to the headset."""
STALE_S = 0.25
"""An older pose is no pose: the tracker counts as lost."""
SILENT_S = 2.0
FOOT_LIMIT_M = 0.005
"""An alignment with a larger standard error of a foot is not good enough to touch boxes with."""
_KEPT_S = WINDOW_S + 4.0
_OTHER_CLOCK_S = 1.0
_KINDS = frozenset({"tracker", "rigid_body", "headset", "controller"})
"""What is somewhere in the room; bones are in their parents, and put together (`WornBones`)."""
NO_BONES: Mapping[str, str] = MappingProxyType({})
_LATENCIES = 2048
_MOST_OTHERS = 16
_HALVES_S = 0.001
Row = tuple[float, ...]
"""A pose at a time, with the columns of `worker_tasks.ROW`."""


@dataclass
class _Newest:
    """The newest pose of a tracker; position and rotation may come in packets of their own."""

    pose: Pose
    at_s: float
    arrival_s: float


@dataclass(frozen=True)
class Seen:
    """A tracker as it is shown: on which limb it is worn, and whether it is tracked now.

    `is_used`: the headset has a goal for the limb, and no other tracker is used for it.
    """

    tracker: str
    limb: str
    is_used: bool
    tracked: bool
    silent_s: float | None


class TrackerLink:
    """What a session's headset gets of the trackers of one source; safe from any thread."""

    def __init__(self, door: str, source: str) -> None:
        self.door = door
        self.source = source
        self._others: dict[str, float] = {}
        self._limbs: dict[str, str] = {}
        self._used: dict[str, str] = {}
        self._bones = WornBones()
        self._worn_bones: frozenset[str] = frozenset()
        self._address: str | None = None
        self._last_s = float("-inf")
        self._newest: dict[str, _Newest] = {}
        self._tracker_rows: deque[Row] = deque()
        self._head_rows: deque[Row] = deque()
        self._head_clock = SourceClock()
        self._head_last_s = float("-inf")
        self._is_new_run = True
        self._step: WatchStep | None = None
        self._watched_to_s = float("-inf")
        self._generation = 0
        self._latencies_s: deque[float] = deque(maxlen=_LATENCIES)
        self._lock = threading.RLock()

    @property
    def address(self) -> str | None:
        """Return the sender whose samples are used; None before the first one."""
        return self._address

    @property
    def reference(self) -> str | None:
        """Return the name of the tracker on the head; None if no tracker is worn there."""
        return self._used.get(REFERENCE)

    def wear(self, limbs: Mapping[str, str], bones: Mapping[str, str] = NO_BONES) -> None:
        """Take on which limb each tracker is worn; another one on the head starts anew.

        `bones`: the limbs of a suit's bones, which count where no tracker is worn.
        """
        taken = set(limbs.values())
        used = {bone: limb for bone, limb in bones.items() if limb not in taken}
        with self._lock:
            self._worn_bones = frozenset(used)
            self._limbs = dict(sorted({**used, **limbs}.items()))
            self._choose(self._last_s)

    def others(self, now_s: float) -> list[str]:
        """Return the addresses of other senders of the same name that send now; none is used."""
        with self._lock:
            return sorted(one for one, at_s in self._others.items() if now_s - at_s <= SILENT_S)

    def doubled(self, now_s: float) -> dict[str, list[str]]:
        """Return the limbs of the headset's on which several trackers send now, with these.

        The first by name is used, another one only while that sends nothing.
        """
        found: dict[str, list[str]] = {}
        with self._lock:
            for tracker, limb in self._limbs.items():
                if limb in GOALS and not self._is_silent(tracker, now_s):
                    found.setdefault(limb, []).append(tracker)
        return {limb: trackers for limb, trackers in found.items() if len(trackers) > 1}

    def begin_run(self) -> None:
        """Expect the head of a headset that has just connected; its clock may be another one."""
        with self._lock:
            self._is_new_run = True

    def take_head(self, poses: Sequence[HeadPose], arrival_s: float) -> list[Sample]:
        """Take where the headset's eyes were; return them as samples, without those sent before."""
        with self._lock:
            if self._is_new_run:
                self._start_run(poses[0].t_s, arrival_s)
            newest = self._head_rows[-1][0] if self._head_rows else float("-inf")
            fresh = [one for one in poses if one.t_s > newest]
            if not fresh:
                return []
            self._head_clock.note(fresh[-1].t_s, arrival_s)
            self._head_last_s = arrival_s
            for one in fresh:
                _append(self._head_rows, (one.t_s, *one.place, float(one.tracked)))
            offset_s, uncertainty_s = self._head_clock.offset_s, self._head_clock.uncertainty_s
        return [
            Sample(
                door="headset",
                source="headset",
                address="",
                poses=(Pose("eyes", "headset", one.place[:3], one.place[3:], tracked=one.tracked),),
                source_s=one.t_s,
                arrival_s=arrival_s,
                mapped_s=one.t_s + (offset_s or 0.0),
                uncertainty_s=uncertainty_s,
            )
            for one in fresh
        ]

    def take(self, sample: Sample) -> bool:
        """Take a sample of this source; return whether a limb of the headset's has moved."""
        with self._lock:
            if sample.address != self._address:
                if sample.arrival_s - self._last_s <= SILENT_S:
                    self._others[sample.address] = sample.arrival_s
                    if len(self._others) > _MOST_OTHERS:
                        del self._others[min(self._others, key=self._others.__getitem__)]
                    return False
                self._address = sample.address
                self._others.pop(sample.address, None)
            self._last_s = sample.arrival_s
            worn = [
                self._completed(pose, sample)
                for pose in (*sample.poses, *self._bones.of(sample, self._worn_bones))
                if pose.tracker in self._limbs and pose.kind in _KINDS
            ]
            self._choose(sample.arrival_s)
            moved = False
            for whole in worn:
                limb = self._limbs[whole.tracker]
                if self._used[limb] != whole.tracker:
                    continue
                if limb == REFERENCE:
                    self._keep_reference(whole, sample)
                elif limb in GOALS:
                    moved = moved or whole.rotation is not None
            return moved

    def places(self, now_s: float) -> TrackerPlaces | None:
        """Return where the trackers are in the headset's world; None while that is not known."""
        with self._lock:
            watched = None if self._step is None else self._step.watched
            offset_s = self._head_clock.offset_s
            if watched is None or watched.alignment is None or not watched.holds:
                return None
            if offset_s is None:
                return None
            found = [
                (limb, one)
                for limb, tracker in self._used.items()
                if limb in GOALS
                and limb != REFERENCE
                and (one := self._newest.get(tracker)) is not None
                and _is_here(one, now_s)
            ]
            alignment = watched.alignment
        if not found:
            return TrackerPlaces(t_s=max(0.0, now_s - offset_s), places={})
        at_s = np.array([one.at_s - offset_s for _, one in found])
        rotations = np.array([one.pose.rotation for _, one in found], dtype=np.float64)
        rotations /= np.linalg.norm(rotations, axis=1, keepdims=True)
        times_s, positions_m, turned = alignment.to_headset(
            at_s, np.array([one.pose.position_m for _, one in found]), rotations
        )
        return TrackerPlaces.model_construct(
            t_s=float(times_s.max()),
            places={
                cast("Goal", limb): cast("Place", (*position, *rotation))
                for (limb, _), position, rotation in zip(
                    found, positions_m.tolist(), turned.tolist(), strict=True
                )
            },
        )

    def sent(self, now_s: float) -> None:
        """Note that the newest poses were written to the headset's socket now."""
        with self._lock:
            arrivals = [
                self._newest[tracker].arrival_s
                for limb, tracker in self._used.items()
                if limb in GOALS and limb != REFERENCE and tracker in self._newest
            ]
            if arrivals:
                self._latencies_s.append(now_s - max(arrivals))

    def to_watch(self, now_s: float) -> tuple[int, Watched | None, FloatArray, FloatArray] | None:
        """Return what a step of watching takes, with a number for its answer; None if too little.

        Head and tracker are both by the headset's clock.
        """
        with self._lock:
            offset_s = self._head_clock.offset_s
            if offset_s is None or len(self._head_rows) < 2 or len(self._tracker_rows) < 2:
                return None
            if now_s - self._head_last_s > SILENT_S or self._watched_to_s >= self._head_last_s:
                return None
            self._watched_to_s = self._head_last_s
            head, tracker = list(self._head_rows), list(self._tracker_rows)
            watched = None if self._step is None else self._step.watched
            number = self._generation
        by_server = np.array(tracker)
        by_server[:, 0] -= offset_s
        return number, watched, np.array(head), by_server

    def take_step(self, number: int, step: WatchStep) -> bool:
        """Take the answer to a step of watching; return whether it is still about this link."""
        with self._lock:
            if number != self._generation:
                return False
            self._step = step
            return True

    def status(self, now_s: float) -> Status:
        """Return whether the headset gets the trackers, or what is missing."""
        with self._lock:
            reference = self.reference
            if reference is None:
                return "no_reference"
            if self._is_silent(reference, now_s):
                return "silent"
            if now_s - self._head_last_s > SILENT_S:
                return "no_headset"
            watched = None if self._step is None else self._step.watched
            if watched is None or watched.alignment is None:
                return "looking"
            return "aligned" if watched.holds else "lost"

    def headset_s(self, server_s: float) -> float:
        """Return the headset's time at a time of the server; the server's before they are known."""
        return server_s - (self._head_clock.offset_s or 0.0)

    def step(self) -> WatchStep | None:
        """Return the newest step of watching; None before the first one."""
        return self._step

    def trackers(self, now_s: float) -> list[Seen]:
        """Return the trackers that are worn, and whether each is tracked now."""
        with self._lock:
            return [
                Seen(
                    tracker,
                    limb,
                    limb in GOALS and self._used[limb] == tracker,
                    (one := self._newest.get(tracker)) is not None and _is_here(one, now_s),
                    None if one is None else now_s - one.arrival_s,
                )
                for tracker, limb in self._limbs.items()
            ]

    def latencies_s(self) -> list[float]:
        """Return the newest times from a packet's arrival to the headset's socket."""
        with self._lock:
            return list(self._latencies_s)

    def _completed(self, pose: Pose, sample: Sample) -> Pose:
        """Return a pose together with the half that came in a packet before."""
        before = self._newest.get(pose.tracker)
        if before is not None and (pose.position_m is None or pose.rotation is None):
            pose = replace(
                pose,
                position_m=pose.position_m or before.pose.position_m,
                rotation=pose.rotation or before.pose.rotation,
            )
        self._newest[pose.tracker] = _Newest(pose, sample.mapped_s, sample.arrival_s)
        return pose

    def _keep_reference(self, pose: Pose, sample: Sample) -> None:
        if pose.position_m is None or pose.rotation is None:
            return
        # Two halves of one pose have one time, or nearly: the complete one comes last.
        if self._tracker_rows and sample.mapped_s - self._tracker_rows[-1][0] < _HALVES_S:
            self._tracker_rows.pop()
        row = (sample.mapped_s, *pose.position_m, *pose.rotation, float(pose.tracked))
        _append(self._tracker_rows, row)

    def _start_run(self, t_s: float, arrival_s: float) -> None:
        """Begin with a headset's clock, or go on if it is the same one.

        Another clock is that of a page that was loaded anew: its world may be another one, too, so
        the alignment holds again only once it was fitted to what comes from now on.
        """
        self._is_new_run = False
        offset_s = self._head_clock.offset_s
        if offset_s is not None and abs(arrival_s - t_s - offset_s) < _OTHER_CLOCK_S:
            return
        self._head_clock = SourceClock()
        self._head_rows.clear()
        self._generation += 1
        step = self._step
        if step is None or step.watched.alignment is None:
            self._step = None
            return
        alignment = replace(
            step.watched.alignment, drift_m_s=np.zeros(3), reference_s=t_s, start_s=t_s, end_s=t_s
        )
        self._step = WatchStep(Watched(alignment, False, t_s, t_s))

    def _choose(self, now_s: float) -> None:
        """Choose the tracker of each limb: the first by name of those that send."""
        before, used = self.reference, dict[str, str]()
        for tracker, limb in self._limbs.items():
            known = used.get(limb)
            if known is None or (
                self._is_silent(known, now_s) and not self._is_silent(tracker, now_s)
            ):
                used[limb] = tracker
        self._used = used
        if self.reference != before:
            self._forget_alignment()

    def _is_silent(self, tracker: str, now_s: float) -> bool:
        newest = self._newest.get(tracker)
        return newest is None or now_s - newest.arrival_s > SILENT_S

    def _forget_alignment(self) -> None:
        self._generation += 1
        self._step = None
        self._tracker_rows.clear()


def _is_here(one: _Newest, now_s: float) -> bool:
    pose = one.pose
    is_whole = pose.position_m is not None and pose.rotation is not None
    return is_whole and pose.tracked and now_s - one.arrival_s <= STALE_S


def _append(rows: deque[Row], row: Row) -> None:
    """Append a row that is later than the last one, and forget those that are too old."""
    if rows and row[0] <= rows[-1][0]:
        return
    rows.append(row)
    while row[0] - rows[0][0] > _KEPT_S:
        rows.popleft()
