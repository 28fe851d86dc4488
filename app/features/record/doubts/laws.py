"""What a headset says of a session, held against what can be: the laws, without a database.

A headset measures everything by itself, and the server cannot look. But its words hang together:
active time passes on its own clock and no faster than on the server's, a contact ends after it
began, nobody completes a task in a blink. What breaks such a law cannot be true, whoever said it.
Each law is generous: what it lets pass may be wrong, what it does not let pass is.

Late is no lie. A headset that was offline brings its journal when it is back, so reports that
describe ten minutes may arrive within one second. The server's clock therefore bounds from above
only: what is told at a moment cannot have taken longer than the time since the server called the
phase.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from typing import NamedTuple

KINDS: dict[str, str] = {
    "active_time_headset": "more active time than passed on the headset's own clock",
    "active_time_server": "more active time than passed at the server since the phase was called",
    "active_time_frames": "active time that its frames do not cover, or frames beyond it",
    "time_backwards": "times that run backwards or are no numbers",
    "contact_backwards": "contacts that end before they begin, or hold more active time than time",
    "contact_place": "contacts with boxes that the phase does not have",
    "contact_time": "contacts outside the phase's active time",
    "completion_place": "completions in a phase without this task, or of boxes it does not have",
    "completion_time": "completions outside the phase's active time",
    "completion_pace": "completions faster than anybody could be",
    "completion_count": "more completions than numbers or touched targets account for",
    "walk_back": "walks back in a phase without them",
    "epoch": "runs of the headset that the server gave no number to",
    "count": "more frames or reports than a headset can make",
    "observed": "what the server noticed itself while the headset was connected",
}
"""Every kind of doubt there is, with what it means."""

CLOCK_S = 0.1
"""Two readings of one clock may differ by this: a few frames of the slowest headset."""
SERVER_S = 0.25
DRIFT = 1e-3
"""What two clocks may differ by: a moment, and ten times the drift of a bad crystal."""
FRAMES_S, FRAMES_SHARE = 1.0, 0.02
"""What the frames of a phase may lack: their ends, and a share of them."""
TOUCH_S = 0.05
"""Nobody touches one thing after the other quicker: people tap a finger 7 times a second at best,
and these things stand apart."""
MOST_PER_S, HEAD_START_S = 1000.0, 60.0
"""The most frames (or reports) that a headset makes in a second of its clock; none shows half so
many. A run is given this much time before the server first heard of it."""
_STARTS = ("started", "resumed", "walk_back_ended")


@dataclass(frozen=True)
class Doubt:
    """Something in a session's record that cannot be true.

    `phase_id` is None where it is about the session and not about one phase. `kind` is one of
    `KINDS`. `claimed` was said and `possible` is the furthest it can have been, both in `unit`;
    None where no figure says it.
    """

    phase_id: int | None
    kind: str
    words: str
    claimed: float | None = None
    possible: float | None = None
    unit: str | None = None


class ClockReport(NamedTuple):
    """What a run of the headset said of a clock, at its own time."""

    phase_id: int
    epoch: int
    what: str
    t_s: float
    active_s: float
    accepted: bool


class Moment(NamedTuple):
    """An event of a phase, by both clocks of the server.

    `active_s` is what the headset claimed with it, if it did. `stands`: it said itself that its
    clock stands from here.
    """

    type: str
    monotonic_s: float
    utc: datetime
    active_s: float | None
    stands: bool


class Contacts(NamedTuple):
    """The contacts of a phase by one run, put together; times in s of its clock and active time.

    `offset_*`: a time of the clock less the active time then. `reversed`: how many end before they
    begin or hold more active time than time. `elsewhere`: how many are with things of the other
    task.
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
    """A completed task, as it was told."""

    epoch: int
    number: int
    at_s: float
    active_s: float
    duration_s: float
    order: tuple[int, ...]


class Coverage(NamedTuple):
    """What the frames of a phase cover: their active time with gaps, the gaps, faulty times."""

    frames: int
    span_s: float
    gap_s: float
    backwards: int


@dataclass(frozen=True)
class PhaseClaims:
    """A phase, as the study has it and as the headset tells it.

    `boxes`: how many the task has; 0 where there is none. `coverage` is None until it is computed.
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


class StreamClaim(NamedTuple):
    """How much of a stream came, and how much there is said to be.

    `known_s`: for how long the server had known of the run when it heard of it last.
    """

    stream: str
    epoch: int
    stored: int
    produced: int
    known_s: float


@dataclass(frozen=True)
class SessionClaims:
    """Everything that a headset said of a session. `reports` in the order of each run's seqs."""

    time_scale: float
    reports: tuple[ClockReport, ...] = ()
    phases: tuple[PhaseClaims, ...] = ()
    streams: tuple[StreamClaim, ...] = ()
    observed: tuple[str, ...] = ()


def doubts_about(claims: SessionClaims) -> tuple[Doubt, ...]:
    """Everything that cannot be, by phase (the session's own first), one of each kind.

    Where a law is broken several times in a phase, the worst case is told.
    """
    found: list[Doubt] = [*_runs(claims), *_streams(claims), *_backwards(claims.reports)]
    found += [Doubt(None, "observed", words) for words in claims.observed]
    for phase in claims.phases:
        reports = [one for one in claims.reports if one.phase_id == phase.phase_id]
        found += _clock(phase, reports)
        found += _server(phase, claims.time_scale)
        found += _frames(phase, reports)
        if reports:
            # Without a word about its clock the phase was not run by a headset of this protocol.
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


def beyond_reason(count: int, known_s: float, time_scale: float = 1.0) -> bool:
    """Whether no headset can have made so much in the time for which its run is known."""
    return count > most_made(known_s, time_scale)


def most_made(known_s: float, time_scale: float) -> float:
    """How many frames (or reports) of one stream a run can have made."""
    return MOST_PER_S * time_scale * (max(known_s, 0.0) + HEAD_START_S)


def _runs(claims: SessionClaims) -> Iterator[Doubt]:
    """Runs are numbered 1, 2, ... by the server, and each number is on record when it is given."""
    epochs = {one.epoch for one in claims.streams}
    given = 0
    while given + 1 in epochs:
        given += 1
    for epoch in sorted(epochs):
        if not 1 <= epoch <= given:
            words = f"data came under run {epoch} of the headset, which the server did not number"
            yield Doubt(None, "epoch", words, epoch, given)


def _streams(claims: SessionClaims) -> Iterator[Doubt]:
    for one in claims.streams:
        most = most_made(one.known_s, claims.time_scale)
        for count, verb in ((one.stored, "came"), (one.produced, "are said to exist")):
            if count > most:
                words = (
                    f"{count} of stream {one.stream}, run {one.epoch}, {verb} within"
                    f" {one.known_s:.0f} s"
                )
                yield Doubt(None, "count", words, count, most)


def _backwards(reports: Sequence[ClockReport]) -> Iterator[Doubt]:
    for before, after in pairwise(reports):
        if before.epoch == after.epoch and after.t_s < before.t_s:
            words = (
                f"{after.what!r} is told for {after.t_s:.3f} s, behind {before.what!r} at"
                f" {before.t_s:.3f} s"
            )
            yield Doubt(after.phase_id or None, "time_backwards", words, after.t_s, before.t_s, "s")


def _clock(phase: PhaseClaims, reports: Sequence[ClockReport]) -> Iterator[Doubt]:
    """Active time passes with the headset's clock while it runs, and not at all while it stands."""
    for _, own in _by_epoch(reports):
        # Of a report that was refused nobody can say whether the headset acted on it.
        accepted = [one for one in own if one.accepted]
        broken = list(_gained(phase, own))
        if broken and (found := list(_gained(phase, accepted))):
            yield from found
    for one in reports:
        if one.accepted and one.what.startswith("walk_back") and phase.limb != "foot":
            yield Doubt(phase.phase_id, "walk_back", "a walk back is told, and there is none")


def _gained(phase: PhaseClaims, own: Sequence[ClockReport]) -> Iterator[Doubt]:
    # A run that takes over learns how far the one before had come until it runs itself.
    known = False
    for before, after in pairwise(own):
        runs = before.what in _STARTS
        known = known or runs or before.what == "started"
        if not known:
            continue
        passed_s = max(after.t_s - before.t_s, 0.0) if runs else 0.0
        gained_s = after.active_s - before.active_s
        if gained_s > passed_s + CLOCK_S:
            words = (
                f"{gained_s:.2f} s of active time from {before.what!r} to {after.what!r}, while"
                f" the headset's clock {'went' if runs else 'ran'} {passed_s:.2f} s of it"
            )
            yield Doubt(phase.phase_id, "active_time_headset", words, gained_s, passed_s, "s")
        elif gained_s < -CLOCK_S:
            words = f"the active time fell from {before.active_s:.2f} s to {after.active_s:.2f} s"
            yield Doubt(
                phase.phase_id, "time_backwards", words, after.active_s, before.active_s, "s"
            )


def _server(phase: PhaseClaims, time_scale: float) -> Iterator[Doubt]:
    """No more active time than passed at the server since it called the phase.

    Pauses that the headset itself confirmed are left out of it, until the operator lets it go on:
    it cannot have gone on before.
    """
    called, stood_since, stood_s = None, None, 0.0
    for moment in phase.moments:
        if moment.type == "phase_prepared":
            called = moment
        if called is None:
            continue
        if moment.active_s is not None:
            passed_s = max(_passed_s(called, moment)) - stood_s
            possible_s = passed_s * time_scale * (1.0 + DRIFT)
            if moment.active_s > possible_s + SERVER_S:
                words = (
                    f"{moment.active_s:.2f} s of active time were told {passed_s:.2f} s after the"
                    " phase was called, pauses left out"
                )
                yield Doubt(
                    phase.phase_id,
                    "active_time_server",
                    words,
                    moment.active_s,
                    possible_s,
                    "s",
                )
        if moment.type == "resume_requested" and stood_since is not None:
            stood_s += max(0.0, min(_passed_s(stood_since, moment)))
        if moment.type != "phase_paused" or not moment.stands:
            stood_since = None
        elif stood_since is None:
            stood_since = moment


def _passed_s(first: Moment, second: Moment) -> tuple[float, float]:
    """The time between two moments by both clocks of the server: either may have been set."""
    return (
        second.monotonic_s - first.monotonic_s,
        (second.utc - first.utc).total_seconds(),
    )


def _frames(phase: PhaseClaims, reports: Sequence[ClockReport]) -> Iterator[Doubt]:
    covered = phase.coverage
    if covered is None or phase.status != "done":
        return
    if covered.backwards:
        words = f"{covered.backwards} frame(s) are not later than the one before, or have no time"
        yield Doubt(phase.phase_id, "time_backwards", words, covered.backwards, 0)
    if not covered.frames:
        return  # the receipt tells that there are none
    spare_s = FRAMES_S + FRAMES_SHARE * phase.active_s
    if phase.active_s > covered.span_s + spare_s:
        words = f"{phase.active_s:.2f} s are said to be active, frames cover {covered.span_s:.2f} s"
        claimed, possible = phase.active_s, covered.span_s
        yield Doubt(phase.phase_id, "active_time_frames", words, claimed, possible, "s")
    # A run that was lost may bring frames later than the one that took over knew of.
    seen_s = covered.span_s - covered.gap_s
    if len({one.epoch for one in reports}) == 1 and seen_s > phase.active_s + spare_s:
        words = f"frames of {seen_s:.2f} s are said to be active, of {phase.active_s:.2f} s"
        yield Doubt(phase.phase_id, "active_time_frames", words, seen_s, phase.active_s, "s")


class _Running(NamedTuple):
    """Where a phase's clock ran in one run: from, to, and its lag behind the run's own clock."""

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


def _by_epoch(reports: Iterable[ClockReport]) -> Iterator[tuple[int, list[ClockReport]]]:
    runs: dict[int, list[ClockReport]] = {}
    for one in reports:
        runs.setdefault(one.epoch, []).append(one)
    yield from runs.items()


def _contacts(phase: PhaseClaims, reports: Sequence[ClockReport]) -> Iterator[Doubt]:
    runs = dict(_by_epoch(reports))
    for one in phase.contacts:
        if one.reversed:
            words = f"{one.reversed} contact(s) end before they begin, or last longer than they do"
            yield Doubt(phase.phase_id, "contact_backwards", words, one.reversed, 0)
        if one.elsewhere or phase.limb is None:
            words = f"{one.elsewhere} contact(s) with things that the phase does not have"
            yield Doubt(phase.phase_id, "contact_place", words, one.elsewhere, 0)
        elif one.highest_box is not None and one.highest_box > phase.boxes:
            words = f"a contact with box {one.highest_box}; the task has {phase.boxes}"
            yield Doubt(phase.phase_id, "contact_place", words, one.highest_box, phase.boxes)
        running = _running(runs.get(one.epoch, []))
        last_s = phase.duration_s + CLOCK_S
        if running is None:
            words = f"contacts of run {one.epoch}, in which the phase's clock never ran"
            yield Doubt(phase.phase_id, "contact_time", words)
        elif one.last_active_s > last_s:
            words = f"a contact at {one.last_active_s:.2f} s of active time, of {last_s:.2f} s"
            yield Doubt(phase.phase_id, "contact_time", words, one.last_active_s, last_s, "s")
        elif (
            one.first_s < running.first_s - CLOCK_S
            or one.last_s > running.last_s + CLOCK_S
            or one.offset_first_s < running.offset_first_s - CLOCK_S
            or one.offset_last_s > running.offset_last_s + CLOCK_S
        ):
            words = (
                f"contacts from {one.first_s:.2f} to {one.last_s:.2f} s of the headset's clock do"
                " not lie in the phase's active time"
            )
            yield Doubt(phase.phase_id, "contact_time", words)


def _completions(phase: PhaseClaims, reports: Sequence[ClockReport]) -> Iterator[Doubt]:
    about, runs = phase.phase_id, dict(_by_epoch(reports))
    if phase.completed and not phase.boxes:
        words = f"{len(phase.completed)} completion(s) in a phase of kind {phase.kind}"
        yield Doubt(about, "completion_place", words, len(phase.completed), 0)
        return
    quickest_s = (phase.boxes + 1) * TOUCH_S
    # Completions are numbered in the order in which the participant made them.
    ordered = sorted(phase.completed, key=lambda one: one.number)
    before: Completed | None = None
    for place, one in enumerate(ordered, start=1):
        if one.number != place:
            words = f"completion {one.number} is told, and completion {place} never was"
            yield Doubt(about, "completion_count", words, one.number, place)
        if sorted(one.order) != list(range(1, phase.boxes + 1)):
            words = f"completion {one.number} is of boxes {list(one.order)}, of {phase.boxes}"
            yield Doubt(about, "completion_place", words, len(one.order), phase.boxes)
        last_s = 0.0 if before is None else before.active_s
        # A run that takes over may have been told of fewer seconds than the one before had used.
        same = before is None or before.epoch == one.epoch
        took_s = min(one.duration_s, one.active_s - last_s) if same else one.duration_s
        if took_s < quickest_s - CLOCK_S / 10:
            words = f"completion {one.number} took {took_s:.3f} s for {phase.boxes + 1} touches"
            yield Doubt(about, "completion_pace", words, took_s, quickest_s, "s")
        if same and one.duration_s > one.active_s - last_s + CLOCK_S:
            since_s = one.active_s - last_s
            words = f"completion {one.number} took {one.duration_s:.2f} s, of {since_s:.2f} s"
            yield Doubt(about, "completion_time", words, one.duration_s, since_s, "s")
        yield from _in_time(phase, one, _running(runs.get(one.epoch, [])))
        before = one
    yield from _touched(phase)


def _in_time(phase: PhaseClaims, one: Completed, running: _Running | None) -> Iterator[Doubt]:
    offset_s = one.at_s - one.active_s
    fits = running is not None and (
        running.first_s - CLOCK_S <= one.at_s <= running.last_s + CLOCK_S
        and running.offset_first_s - CLOCK_S <= offset_s <= running.offset_last_s + CLOCK_S
    )
    if not fits or one.active_s > phase.duration_s + CLOCK_S:
        words = (
            f"completion {one.number} at {one.at_s:.2f} s of the headset's clock does not lie in"
            " the phase's active time"
        )
        yield Doubt(phase.phase_id, "completion_time", words, one.active_s, phase.duration_s, "s")


def _touched(phase: PhaseClaims) -> Iterator[Doubt]:
    """Every completion ends at the target; the last contact of a run may be lost with it."""
    touched = {one.epoch: one.completing for one in phase.contacts}
    for epoch in sorted({one.epoch for one in phase.completed}):
        told = sum(one.epoch == epoch for one in phase.completed)
        possible = touched.get(epoch, 0) + 1
        if told > possible:
            words = f"{told} completions are told, and the target was touched {possible - 1} times"
            yield Doubt(phase.phase_id, "completion_count", words, told, possible)
