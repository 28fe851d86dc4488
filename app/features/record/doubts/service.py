"""Read the claims of sessions from the record, and determine the doubts about them.

Everything is recomputed from what is stored, with the same few queries for one session or for many.
Contacts are the most numerous, so they are aggregated in SQL.
"""

import json
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping
from datetime import datetime
from typing import Any

from sqlalchemy import ColumnElement, and_, case, func, or_, select
from sqlalchemy.orm import Session

from app.features.design.studies import version_content
from app.features.record.doubts.laws import (
    CLOCK_S,
    ClockReport,
    Completed,
    Contacts,
    Coverage,
    Doubt,
    Moment,
    PhaseClaims,
    SessionClaims,
    StreamClaim,
    doubts_about,
)
from app.features.record.doubts.statures import read_statures
from app.features.record.sessions import judge_again, plans_of
from app.models import (
    AlarmRow,
    ClientReport,
    Completion,
    Contact,
    Phase,
    PhaseQuality,
    SessionEvent,
    StudySession,
    TelemetryStream,
)
from app.protocol import BOX_KINDS, ROAD_KINDS, StudyProtocol
from app.wire import BODY_STREAMS

OBSERVED = "impossible"
"""The code of the alarm for contradictions that only the connection can see, not the record."""
_MOMENTS = (
    "phase_prepared",
    "phase_paused",
    "resume_requested",
    "phase_resumed",
    "walk_back_started",
    "walk_back_ended",
    "phase_frozen",
    "phase_ended",
)
_NS_PER_S = 1e9
Key = tuple[str, int]
"""Session id and phase id."""


def doubts_of(db: Session, session_id: str) -> tuple[Doubt, ...]:
    """Return the doubts about a session: first those about it as a whole, then phase by phase."""
    return doubts_of_sessions(db, StudySession.id == session_id).get(session_id, ())


def doubts_of_sessions(db: Session, chosen: ColumnElement[bool]) -> dict[str, tuple[Doubt, ...]]:
    """Return the doubts by session id for all `chosen` sessions that have any."""
    claims = _Reader(db, chosen).read()
    found = {session_id: doubts_about(one) for session_id, one in claims}
    return {session_id: doubts for session_id, doubts in found.items() if doubts}


def judge_with_doubts(db: Session, session: StudySession) -> None:
    """Decide whether a completed session is valid, taking the doubts about it into account.

    Call this after every step that may have been the last one.
    """
    if session.status == "completed":
        judge_again(db, session, [one.phase_id for one in doubts_of(db, session.id)])


class _Reader:
    """Reads the claims of the chosen sessions, table by table."""

    def __init__(self, db: Session, chosen: ColumnElement[bool]) -> None:
        self._db, self._chosen = db, chosen

    def read(self) -> Iterator[tuple[str, SessionClaims]]:
        """Yield each session's id with its claims."""
        reports = self._by_session(self._reports())
        moments, lengths_s = self._moments()
        streams = self._streams(lengths_s)
        observed = self._by_session(self._observed())
        phases = self._phases(moments)
        query = select(StudySession.id, StudySession.time_scale).where(self._chosen)
        for session_id, time_scale in self._db.execute(query.order_by(StudySession.id)).all():
            yield (
                session_id,
                SessionClaims(
                    time_scale=time_scale,
                    reports=tuple(reports[session_id]),
                    phases=tuple(phases[session_id]),
                    streams=tuple(streams[session_id]),
                    observed=tuple(observed[session_id]),
                ),
            )

    def _of_chosen(self, query: Any, table: Any) -> Any:
        """Execute a query on a table that has a session id, restricted to the chosen sessions."""
        joined = query.join(StudySession, StudySession.id == table.session_id)
        return self._db.execute(joined.where(self._chosen))

    @staticmethod
    def _by_session(pairs: Iterable[tuple[str, Any]]) -> dict[str, list[Any]]:
        found: dict[str, list[Any]] = defaultdict(list)
        for session_id, value in pairs:
            found[session_id].append(value)
        return found

    def _reports(self) -> Iterator[tuple[str, ClockReport]]:
        query = (
            select(
                ClientReport.session_id,
                ClientReport.epoch,
                ClientReport.payload,
                ClientReport.accepted,
            )
            .where(ClientReport.type.in_(("phase", "materialised")))
            .order_by(ClientReport.session_id, ClientReport.epoch, ClientReport.seq)
        )
        for session_id, epoch, payload, accepted in self._of_chosen(query, ClientReport):
            yield (
                session_id,
                ClockReport(
                    phase_id=payload.get("phase_id", 0),
                    epoch=epoch,
                    what=payload.get("what", payload["kind"]),
                    t_s=payload["t_s"],
                    active_s=payload.get("active_s", 0.0),
                    accepted=accepted,
                ),
            )

    def _moments(self) -> tuple[dict[Key, list[Moment]], dict[str, float]]:
        """Return each phase's clock events, and the duration of each session in seconds."""
        query = (
            select(
                SessionEvent.session_id,
                SessionEvent.type,
                SessionEvent.payload,
                SessionEvent.monotonic_ns,
                SessionEvent.recorded_at,
            )
            .where(SessionEvent.type.in_(_MOMENTS))
            .order_by(SessionEvent.session_id, SessionEvent.seq)
        )
        found: dict[Key, list[Moment]] = defaultdict(list)
        first: dict[str, Moment] = {}
        lengths_s: dict[str, float] = {}
        for session_id, kind, payload, monotonic_ns, utc in self._of_chosen(query, SessionEvent):
            fields = json.loads(payload)
            moment = Moment(
                type=kind,
                monotonic_s=monotonic_ns / _NS_PER_S,
                utc=utc,
                active_s=fields.get("active_s"),
                clock_stopped=fields.get("client_t_s") is not None,
            )
            found[session_id, fields["phase_id"]].append(moment)
            begin = first.setdefault(session_id, moment)
            lengths_s[session_id] = max(
                moment.monotonic_s - begin.monotonic_s, (utc - begin.utc).total_seconds()
            )
        return found, lengths_s

    def _streams(self, lengths_s: Mapping[str, float]) -> dict[str, list[StreamClaim]]:
        table = TelemetryStream
        query = select(
            table.session_id,
            table.stream,
            table.epoch,
            table.next_seq,
            table.produced,
            table.first_at,
            table.last_at,
            StudySession.created_at,
            StudySession.ended_at,
        )
        found: dict[str, list[StreamClaim]] = defaultdict(list)
        for session_id, stream, epoch, stored, produced, *times in self._of_chosen(query, table):
            age_s = max(_lasted_s(*times), lengths_s.get(session_id, 0.0))
            found[session_id].append(StreamClaim(stream, epoch, stored, produced, age_s))
        return found

    def _observed(self) -> Iterator[tuple[str, str]]:
        query = select(AlarmRow.session_id, AlarmRow.message).where(
            AlarmRow.code == OBSERVED, AlarmRow.state == "raised"
        )
        yield from self._of_chosen(query.order_by(AlarmRow.at, AlarmRow.id), AlarmRow)

    def _phases(self, moments: Mapping[Key, list[Moment]]) -> dict[str, list[PhaseClaims]]:
        contacts, completed = self._contacts(), self._completed()
        coverage = self._coverage()
        rows = self._of_chosen(select(Phase), Phase).scalars().all()
        statures = read_statures(self._db, self._chosen, rows)
        plans = plans_of(self._db, self._chosen)
        query = select(StudySession.id, StudySession.study_version_id).where(self._chosen)
        versions = {one.id: one.study_version_id for one in self._db.execute(query)}
        boxes: dict[tuple[str, str, str | None], int] = {}
        found: dict[str, list[PhaseClaims]] = defaultdict(list)
        for row in sorted(rows, key=lambda one: (one.session_id, one.phase_id)):
            key = (row.session_id, row.phase_id)
            place = (versions[row.session_id], row.kind, row.limb)
            if place not in boxes:
                boxes[place] = _boxes(version_content(self._db, place[0]).protocol, row)
            claims = PhaseClaims(
                phase_id=row.phase_id,
                kind=row.kind,
                limb=row.limb,
                status=row.status,
                active_s=row.active_s,
                duration_s=plans[row.session_id][row.step_index].duration_s or 0.0,
                boxes=boxes[place],
                moments=tuple(moments.get(key, ())),
                contacts=tuple(contacts.get(key, ())),
                # Those of crossings follow from the record of the road, not from boxes.
                completed=() if row.kind in ROAD_KINDS else tuple(completed.get(key, ())),
                coverage=coverage.get(key),
                statures=statures.get(key, ()),
            )
            found[row.session_id].append(claims)
        return found

    def _contacts(self) -> dict[Key, list[Contacts]]:
        active_s = Contact.end_active_s - Contact.begin_active_s
        time_s = Contact.end_s - Contact.begin_s
        reversed_ = or_(time_s < 0, active_s < 0, active_s > time_s + CLOCK_S)
        here = Contact.surface.like(func.coalesce(Phase.limb, "-").concat("/%"))
        query = (
            select(
                Contact.session_id,
                Contact.phase_id,
                Contact.epoch,
                func.min(Contact.begin_s),
                func.max(Contact.end_s),
                func.min(Contact.begin_active_s),
                func.max(Contact.end_active_s),
                func.min(Contact.begin_s - Contact.begin_active_s),
                func.max(Contact.end_s - Contact.end_active_s),
                _count(reversed_),
                _count(~here),
                func.max(Contact.box),
                _count(Contact.effect == "completed"),
            )
            .join(
                Phase,
                and_(Phase.session_id == Contact.session_id, Phase.phase_id == Contact.phase_id),
            )
            .group_by(Contact.session_id, Contact.phase_id, Contact.epoch)
        )
        found: dict[Key, list[Contacts]] = defaultdict(list)
        for session_id, phase_id, *values in self._of_chosen(query, Contact):
            found[session_id, phase_id].append(Contacts(*values))
        return found

    def _completed(self) -> dict[Key, list[Completed]]:
        columns = (getattr(Completion, name) for name in Completed._fields)
        query = select(Completion.session_id, Completion.phase_id, *columns)
        found: dict[Key, list[Completed]] = defaultdict(list)
        for session_id, phase_id, *values in self._of_chosen(query, Completion):
            done = Completed(*values)
            found[session_id, phase_id].append(done._replace(order=tuple(done.order)))
        return found

    def _coverage(self) -> dict[Key, Coverage]:
        """Return, for each phase, the coverage of the stream that covers more.

        The other stream may have been lost.
        """
        query = select(
            PhaseQuality.session_id,
            PhaseQuality.phase_id,
            PhaseQuality.frames,
            PhaseQuality.span_s,
            PhaseQuality.gap_s,
            PhaseQuality.backwards,
        ).where(PhaseQuality.stream.in_(BODY_STREAMS))
        found: dict[Key, Coverage] = {}
        for session_id, phase_id, *values in self._of_chosen(query, PhaseQuality):
            one, key = Coverage(*values), (session_id, phase_id)
            other = found.get(key, one)
            backwards = one.backwards + (other.backwards if key in found else 0)
            longer = one if one.span_s > other.span_s else other
            found[key] = longer._replace(backwards=backwards)
        return found


def _count(condition: ColumnElement[bool]) -> ColumnElement[int]:
    return func.count(case((condition, 1)))


def _lasted_s(first: datetime, last: datetime, created: datetime, ended: datetime | None) -> float:
    """Return how long an epoch was known or its session lasted, whichever is longer.

    Either clock may have been set in the meantime.
    """
    session_s = 0.0 if ended is None else (ended - created).total_seconds()
    return max((last - first).total_seconds(), session_s)


def _boxes(protocol: StudyProtocol, phase: Phase) -> int:
    """Return how many boxes a phase has: 0 if it has no task."""
    if phase.kind not in BOX_KINDS:
        return 0
    task = protocol.tasks.hand if phase.limb == "hand" else protocol.tasks.foot
    return 0 if task is None else len(task.boxes)
