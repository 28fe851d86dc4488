"""The laws that a headset's reports must satisfy; a report that breaks one cannot be true.

A headset measures everything itself, and the server cannot check the measurements directly. But the
reports must be consistent: active time passes on the headset's own clock, no faster than on the
server's; a contact ends after it began; nobody completes a task in an instant. Each law is
generous: what satisfies it may still be wrong, but what breaks it is certainly wrong. The module
uses no database.

Late reports break no law. A headset that was offline sends its journal when it reconnects, so
reports that describe ten minutes may arrive within one second. The server's clock is therefore only
an upper bound: what a report describes cannot have taken longer than the time since the server
prepared the phase.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from typing import NamedTuple

KINDS: dict[str, str] = {
    "active_time_headset": "more active time than passed on the headset's own clock",
    "active_time_server": "more active time than passed at the server since the phase was prepared",
    "active_time_frames": "active time that no frames cover, or frames beyond the active time",
    "time_backwards": "times that run backwards or are not numbers",
    "contact_backwards": "contacts that end before they begin, or span more active time than time",
    "contact_place": "contacts with boxes that the phase does not have",
    "contact_time": "contacts outside the phase's active time",
    "completion_place": "completions in a phase without this task, or of boxes it does not have",
    "completion_time": "completions outside the phase's active time",
    "completion_pace": "completions faster than humanly possible",
    "completion_count": "more completions than their numbers or the touched targets account for",
    "walk_back": "walks back in a phase that has none",
    "epoch": "epochs of the headset that the server did not assign",
    "count": "more frames or reports than a headset can make",
    "stature": "bodies worn at another stature than the participant's, as stated or calibrated",
    "observed": "contradictions that the server noticed while the headset was connected",
}
"""All kinds of doubt, each with its meaning."""

CLOCK_S = 0.1
"""Tolerance between two readings of one clock: a few frames of the slowest headset."""
SERVER_S = 0.25
DRIFT = 1e-3
"""Tolerance between two clocks: a constant, and ten times the drift of a bad crystal."""
FRAMES_S, FRAMES_SHARE = 1.0, 0.02
"""How much of a phase its frames may fail to cover: a constant at the ends, and a share."""
TOUCH_S = 0.05
"""The shortest possible time between two touches.

People can tap a finger at most 7 times a second, and the things to touch are apart.
"""
STATURE_M = 0.15
"""How far two statures of one person may be apart: shoes, a guess at one's own height, and an eye
height measured in a stoop together. Measuring again is no contradiction."""
MAX_PER_S, HEAD_START_S = 1000.0, 60.0
"""The most frames (or reports) that a headset makes per second of its clock, more than twice what
any headset displays; and how long an epoch may have run before the server first heard of it."""
_STARTS = ("started", "resumed", "walk_back_ended")


@dataclass(frozen=True)
class Doubt:
    """Something in a session's record that cannot be true.

    `phase_id` is None if it concerns the session as a whole. `kind` is one of `KINDS`. `claimed` is
    the reported value and `possible` the furthest possible one, both in `unit`; they are None if no
    figure applies.
    """

    phase_id: int | None
    kind: str
    words: str
    claimed: float | None = None
    possible: float | None = None
    unit: str | None = None


class ClockReport(NamedTuple):
    """A headset's report about a phase's clock: what happened, with its time and active time."""

    phase_id: int
    epoch: int
    what: str
    t_s: float
    active_s: float
    accepted: bool


class Moment(NamedTuple):
    """An event of a phase, with its time on both clocks of the server.

    `active_s` is the active time that the headset reported with it, if any. `clock_stopped`: the
    headset itself reported that the phase's clock stopped with this event.
    """

    type: str
    monotonic_s: float
    utc: datetime
    active_s: float | None
    clock_stopped: bool


class Contacts(NamedTuple):
    """A summary of a phase's contacts in one epoch.

    Times are in seconds of the epoch's clock and of active time. `offset_*`: clock time minus
    active time. `reversed`: how many contacts end before they begin or span more active time than
    elapsed time. `elsewhere`: how many are with surfaces of the other task.
    """

    epoch: int
    first_s: float
    last_s: float
    first_active_s: float
    last_active_s: float
    offset_first_s: float
    offset_last_s: float
    reversed: int
    elsewhere: int
    highest_box: int | None
    completing: int


class Completed(NamedTuple):
    """A completed task, as the headset reported it."""

    epoch: int
    number: int
    at_s: float
    active_s: float
    duration_s: float
    order: tuple[int, ...]


class Coverage(NamedTuple):
    """The coverage of a phase by frames: active time with gaps, the gaps, invalid timestamps."""

    frames: int
    span_s: float
    gap_s: float
    backwards: int


class Stature(NamedTuple):
    """A stature that held in a phase, and whose it is, in the words of a doubt."""

    whose: str
    stature_m: float


@dataclass(frozen=True)
class PhaseClaims:
    """A phase as the study defines it and as the headset reports it.

    `boxes`: how many boxes its task has; 0 if it has no task. `coverage` is None until it is
    computed. `statures`: the participant's, the calibrations' and those of the bodies that were
    worn, from the phase's beginning to its end.
    """

    phase_id: int
    kind: str
    limb: str | None
    status: str
    active_s: float
    duration_s: float
    boxes: int
    moments: tuple[Moment, ...] = ()
    contacts: tuple[Contacts, ...] = ()
    completed: tuple[Completed, ...] = ()
    coverage: Coverage | None = None
    statures: tuple[Stature, ...] = ()


class StreamClaim(NamedTuple):
    """The stored amount of a stream, and the amount that the headset says it has produced.

    `age_s`: how long the server had known the epoch when it last heard of it.
    """

    stream: str
    epoch: int
    stored: int
    produced: int
    age_s: float


@dataclass(frozen=True)
class SessionClaims:
    """Everything a headset reported in a session; `reports` are in order of each epoch's `seq`."""

    time_scale: float
    reports: tuple[ClockReport, ...] = ()
    phases: tuple[PhaseClaims, ...] = ()
    streams: tuple[StreamClaim, ...] = ()
    observed: tuple[str, ...] = ()


def doubts_about(claims: SessionClaims) -> tuple[Doubt, ...]:
    """Return all doubts about a session, at most one of each kind per phase.

    They are sorted by phase, those about the session as a whole first. If a law is broken several
    times in a phase, the worst case is returned.
    """
    found: list[Doubt] = [*_runs(claims), *_streams(claims), *_backwards(claims.reports)]
    found += [Doubt(None, "observed", message) for message in claims.observed]
    for phase in claims.phases:
        reports = [one for one in claims.reports if one.phase_id == phase.phase_id]
        found += _clock(phase, reports)
        found += _server(phase, claims.time_scale)
        found += _frames(phase, reports)
        found += _statures(phase)
        if reports:
            # A phase without any report of its clock was not run by a headset of this protocol.
            found += _contacts(phase, reports)
            found += _completions(phase, reports)
    worst: dict[tuple[int | None, str, str], Doubt] = {}
    for doubt in found:
        key = (doubt.phase_id, doubt.kind, doubt.words if doubt.claimed is None else "")
        if key not in worst or _excess(doubt) > _excess(worst[key]):
            worst[key] = doubt
    return tuple(sorted(worst.values(), key=lambda one: (one.phase_id or 0, one.kind, one.words)))


def _excess(doubt: Doubt) -> float:
    return abs((doubt.claimed or 0.0) - (doubt.possible or 0.0))


def exceeds_possible(count: int, age_s: float, time_scale: float = 1.0) -> bool:
    """Return whether a stream has more frames or reports than its epoch can have produced."""
    return count > max_made(age_s, time_scale)


def max_made(age_s: float, time_scale: float) -> float:
    """Return the largest number of frames (or reports) that an epoch of this age can have made."""
    return MAX_PER_S * time_scale * (max(age_s, 0.0) + HEAD_START_S)


def _runs(claims: SessionClaims) -> Iterator[Doubt]:
    """Yield a doubt about every epoch that the server did not assign.

    The server assigns 1, 2, ... in order, and records each number when it assigns it.
    """
    epochs = {one.epoch for one in claims.streams}
    assigned = 0
    while assigned + 1 in epochs:
        assigned += 1
    for epoch in sorted(epochs):
        if not 1 <= epoch <= assigned:
            message = f"data arrived under epoch {epoch}, which the server did not assign"
            yield Doubt(None, "epoch", message, epoch, assigned)


def _streams(claims: SessionClaims) -> Iterator[Doubt]:
    for one in claims.streams:
        most = max_made(one.age_s, claims.time_scale)
        for count, verb in ((one.stored, "arrived"), (one.produced, "were claimed")):
            if count > most:
                message = (
                    f"{count} of stream {one.stream}, epoch {one.epoch}, {verb} within"
                    f" {one.age_s:.0f} s"
                )
                yield Doubt(None, "count", message, count, most)


def _backwards(reports: Sequence[ClockReport]) -> Iterator[Doubt]:
    for before, after in pairwise(reports):
        if before.epoch == after.epoch and after.t_s < before.t_s:
            message = (
                f"{after.what!r} at {after.t_s:.3f} s was reported after {before.what!r} at"
                f" {before.t_s:.3f} s"
            )
            yield Doubt(
                after.phase_id or None, "time_backwards", message, after.t_s, before.t_s, "s"
            )


def _clock(phase: PhaseClaims, reports: Sequence[ClockReport]) -> Iterator[Doubt]:
    """Yield doubts about active time that grows faster than the headset's clock allows.

    Active time must not grow while the phase's clock is stopped. Walks back occur only in phases
    with the foot.
    """
    for _, own in _by_epoch(reports):
        # It is unknown whether the headset acted on a report that the server rejected.
        accepted = [one for one in own if one.accepted]
        broken = list(_check_gain(phase, own))
        if broken and (found := list(_check_gain(phase, accepted))):
            yield from found
    for one in reports:
        if one.accepted and one.what.startswith("walk_back") and phase.limb != "foot":
            message = "a walk back was reported in a phase that has none"
            yield Doubt(phase.phase_id, "walk_back", message)


def _check_gain(phase: PhaseClaims, own: Sequence[ClockReport]) -> Iterator[Doubt]:
    # Until it runs the clock itself, an epoch that takes over only repeats the previous epoch's
    # time.
    has_run = False
    for before, after in pairwise(own):
        runs = before.what in _STARTS
        has_run = has_run or runs or before.what == "started"
        if not has_run:
            continue
        passed_s = max(after.t_s - before.t_s, 0.0) if runs else 0.0
        gained_s = after.active_s - before.active_s
        if gained_s > passed_s + CLOCK_S:
            message = (
                f"{gained_s:.2f} s of active time from {before.what!r} to {after.what!r}, although"
                f" the phase's clock ran for only {passed_s:.2f} s"
            )
            yield Doubt(phase.phase_id, "active_time_headset", message, gained_s, passed_s, "s")
        elif gained_s < -CLOCK_S:
            message = (
                f"active time decreased from {before.active_s:.2f} s to {after.active_s:.2f} s"
            )
            yield Doubt(
                phase.phase_id, "time_backwards", message, after.active_s, before.active_s, "s"
            )


def _server(phase: PhaseClaims, time_scale: float) -> Iterator[Doubt]:
    """Yield a doubt if more active time is reported than has passed since the phase was prepared.

    Pauses that the headset itself confirmed are subtracted, up to the operator's request to resume:
    the headset cannot have resumed earlier.
    """
    prepared, paused_since, paused_s = None, None, 0.0
    for moment in phase.moments:
        if moment.type == "phase_prepared":
            prepared = moment
        if prepared is None:
            continue
        if moment.active_s is not None:
            passed_s = max(_passed_s(prepared, moment)) - paused_s
            possible_s = passed_s * time_scale * (1.0 + DRIFT)
            if moment.active_s > possible_s + SERVER_S:
                message = (
                    f"{moment.active_s:.2f} s of active time were reported {passed_s:.2f} s after"
                    " the phase was prepared, not counting pauses"
                )
                yield Doubt(
                    phase.phase_id,
                    "active_time_server",
                    message,
                    moment.active_s,
                    possible_s,
                    "s",
                )
        if moment.type == "resume_requested" and paused_since is not None:
            paused_s += max(0.0, min(_passed_s(paused_since, moment)))
        if moment.type != "phase_paused" or not moment.clock_stopped:
            paused_since = None
        elif paused_since is None:
            paused_since = moment


def _passed_s(first: Moment, second: Moment) -> tuple[float, float]:
    """Return the time between two moments on both server clocks, since either may have been set."""
    return (
        second.monotonic_s - first.monotonic_s,
        (second.utc - first.utc).total_seconds(),
    )


def _frames(phase: PhaseClaims, reports: Sequence[ClockReport]) -> Iterator[Doubt]:
    covered = phase.coverage
    if covered is None or phase.status != "done":
        return
    if covered.backwards:
        message = (
            f"{covered.backwards} frame(s) have no timestamp, or one that is not later than the"
            " previous frame's"
        )
        yield Doubt(phase.phase_id, "time_backwards", message, covered.backwards, 0)
    if not covered.frames:
        return  # the receipt reports that there are none
    spare_s = FRAMES_S + FRAMES_SHARE * phase.active_s
    if phase.active_s > covered.span_s + spare_s:
        message = (
            f"{phase.active_s:.2f} s of active time are claimed, but the frames cover"
            f" {covered.span_s:.2f} s"
        )
        claimed, possible = phase.active_s, covered.span_s
        yield Doubt(phase.phase_id, "active_time_frames", message, claimed, possible, "s")
    # An epoch that was lost may deliver frames that the epoch which took over did not know of.
    seen_s = covered.span_s - covered.gap_s
    if len({one.epoch for one in reports}) == 1 and seen_s > phase.active_s + spare_s:
        message = (
            f"frames of {seen_s:.2f} s are marked active, but the active time is"
            f" {phase.active_s:.2f} s"
        )
        yield Doubt(phase.phase_id, "active_time_frames", message, seen_s, phase.active_s, "s")


class _Running(NamedTuple):
    """The intervals in which a phase's clock ran in one epoch, and its lag behind that epoch's."""

    first_s: float
    last_s: float
    offset_first_s: float
    offset_last_s: float


def _running(own: Sequence[ClockReport]) -> _Running | None:
    starts = [one for one in own if one.what in _STARTS]
    if not starts:
        return None
    still = own[-1].what in _STARTS
    offsets = [one.t_s - one.active_s for one in starts]
    return _Running(
        first_s=min(one.t_s for one in starts),
        last_s=float("inf") if still else max(one.t_s for one in own),
        offset_first_s=min(offsets),
        offset_last_s=max(offsets),
    )


def _statures(phase: PhaseClaims) -> Iterator[Doubt]:
    """Yield a doubt if a phase that counts was done at statures that are not one person's.

    It concerns the session: naming the phase would tell a blinded reader where a body was worn.
    """
    if phase.status == "voided" or not phase.statures:
        return
    low = min(phase.statures, key=lambda one: one.stature_m)
    high = max(phase.statures, key=lambda one: one.stature_m)
    if high.stature_m - low.stature_m > STATURE_M:
        message = (
            f"{low.whose} is {low.stature_m:.2f} m, and {high.whose} {high.stature_m:.2f} m, more"
            f" than {100 * STATURE_M:.0f} cm apart"
        )
        apart_m = high.stature_m - low.stature_m
        yield Doubt(None, "stature", message, apart_m, STATURE_M, "m")


def _by_epoch(reports: Iterable[ClockReport]) -> Iterator[tuple[int, list[ClockReport]]]:
    runs: dict[int, list[ClockReport]] = {}
    for one in reports:
        runs.setdefault(one.epoch, []).append(one)
    yield from runs.items()


def _contacts(phase: PhaseClaims, reports: Sequence[ClockReport]) -> Iterator[Doubt]:
    runs = dict(_by_epoch(reports))
    for one in phase.contacts:
        if one.reversed:
            message = (
                f"{one.reversed} contact(s) end before they begin, or span more active time than"
                " elapsed time"
            )
            yield Doubt(phase.phase_id, "contact_backwards", message, one.reversed, 0)
        if one.elsewhere or phase.limb is None:
            message = f"{one.elsewhere} contact(s) with surfaces that the phase does not have"
            yield Doubt(phase.phase_id, "contact_place", message, one.elsewhere, 0)
        elif one.highest_box is not None and one.highest_box > phase.boxes:
            message = f"a contact with box {one.highest_box}, but the task has {phase.boxes} boxes"
            yield Doubt(phase.phase_id, "contact_place", message, one.highest_box, phase.boxes)
        running = _running(runs.get(one.epoch, []))
        last_s = phase.duration_s + CLOCK_S
        if running is None:
            message = f"contacts in epoch {one.epoch}, in which the phase's clock never ran"
            yield Doubt(phase.phase_id, "contact_time", message)
        elif one.last_active_s > last_s:
            message = (
                f"a contact at {one.last_active_s:.2f} s of active time, but the phase lasts at"
                f" most {last_s:.2f} s"
            )
            yield Doubt(phase.phase_id, "contact_time", message, one.last_active_s, last_s, "s")
        elif (
            one.first_s < running.first_s - CLOCK_S
            or one.last_s > running.last_s + CLOCK_S
            or one.offset_first_s < running.offset_first_s - CLOCK_S
            or one.offset_last_s > running.offset_last_s + CLOCK_S
        ):
            message = (
                f"contacts from {one.first_s:.2f} to {one.last_s:.2f} s of the headset's clock are"
                " outside the phase's active time"
            )
            yield Doubt(phase.phase_id, "contact_time", message)


def _completions(phase: PhaseClaims, reports: Sequence[ClockReport]) -> Iterator[Doubt]:
    about, runs = phase.phase_id, dict(_by_epoch(reports))
    if phase.completed and not phase.boxes:
        message = f"{len(phase.completed)} completion(s) in a phase of kind {phase.kind}"
        yield Doubt(about, "completion_place", message, len(phase.completed), 0)
        return
    quickest_s = (phase.boxes + 1) * TOUCH_S
    # Completions are numbered in the order in which they happened.
    ordered = sorted(phase.completed, key=lambda one: one.number)
    before: Completed | None = None
    for place, one in enumerate(ordered, start=1):
        if one.number != place:
            message = f"completion {one.number} was reported, but completion {place} was not"
            yield Doubt(about, "completion_count", message, one.number, place)
        if sorted(one.order) != list(range(1, phase.boxes + 1)):
            message = (
                f"completion {one.number} is of boxes {list(one.order)}, but the task has boxes 1"
                f" to {phase.boxes}"
            )
            yield Doubt(about, "completion_place", message, len(one.order), phase.boxes)
        last_s = 0.0 if before is None else before.active_s
        # An epoch that takes over may have been sent less active time than the previous one had
        # used.
        same = before is None or before.epoch == one.epoch
        took_s = min(one.duration_s, one.active_s - last_s) if same else one.duration_s
        if took_s < quickest_s - CLOCK_S / 10:
            message = f"completion {one.number} took {took_s:.3f} s for {phase.boxes + 1} touches"
            yield Doubt(about, "completion_pace", message, took_s, quickest_s, "s")
        if same and one.duration_s > one.active_s - last_s + CLOCK_S:
            since_s = one.active_s - last_s
            message = (
                f"completion {one.number} took {one.duration_s:.2f} s, but only {since_s:.2f} s of"
                " active time were available"
            )
            yield Doubt(about, "completion_time", message, one.duration_s, since_s, "s")
        yield from _check_time(phase, one, _running(runs.get(one.epoch, [])))
        before = one
    yield from _check_touches(phase)


def _check_time(phase: PhaseClaims, one: Completed, running: _Running | None) -> Iterator[Doubt]:
    offset_s = one.at_s - one.active_s
    fits = running is not None and (
        running.first_s - CLOCK_S <= one.at_s <= running.last_s + CLOCK_S
        and running.offset_first_s - CLOCK_S <= offset_s <= running.offset_last_s + CLOCK_S
    )
    if not fits or one.active_s > phase.duration_s + CLOCK_S:
        message = (
            f"completion {one.number} at {one.at_s:.2f} s of the headset's clock is outside the"
            " phase's active time"
        )
        yield Doubt(phase.phase_id, "completion_time", message, one.active_s, phase.duration_s, "s")


def _check_touches(phase: PhaseClaims) -> Iterator[Doubt]:
    """Yield a doubt if there are more completions than touches of the target.

    Every completion ends at the target, but the last contact of an epoch may have been lost.
    """
    touched = {one.epoch: one.completing for one in phase.contacts}
    for epoch in sorted({one.epoch for one in phase.completed}):
        reported = sum(one.epoch == epoch for one in phase.completed)
        possible = touched.get(epoch, 0) + 1
        if reported > possible:
            message = (
                f"{reported} completions were reported, but the target was touched"
                f" {possible - 1} times"
            )
            yield Doubt(phase.phase_id, "completion_count", message, reported, possible)
