"""Create sessions, and apply commands to their event logs, each in one transaction."""

import secrets
from collections.abc import Collection, Iterable
from dataclasses import dataclass
from functools import lru_cache, partial, reduce
from typing import NamedTuple

from sqlalchemy import ColumnElement, select
from sqlalchemy.exc import NoResultFound
from sqlalchemy.orm import Session

from app.database import referenced_row
from app.errors import Conflict, InvalidInput, NotNow, StaleVersion
from app.features.design.studies import (
    newest_version,
    protocol_of,
    require_open,
    study_by_key,
    version_content,
)
from app.features.movement.avatar import version_of
from app.features.record.ledger import find_or_add_participant, open_attempt, slot_of, take_slot
from app.features.record.sessions.active_time import with_active_time
from app.features.record.sessions.closed_sessions import require_running
from app.features.record.sessions.engine import (
    Command,
    Refused,
    SessionState,
    decide,
    evolve,
    initial_state,
    state_from_json,
    state_to_json,
)
from app.features.record.sessions.engine.events import SessionEnded
from app.features.record.sessions.journal import append_events, event_of
from app.features.record.sessions.projection import project
from app.features.record.sessions.validity import settle_validity
from app.models import (
    KINDS,
    LedgerSlot,
    Participant,
    SessionEvent,
    SlotAttempt,
    Study,
    StudySession,
    StudyVersion,
    new_id,
)
from app.platform.config_problems import unpacking
from app.platform.context import AppContext
from app.platform.immutable_cache import ImmutableCache
from app.protocol import Step, StudyProtocol, compile_plan, parse_study_json

_plans: ImmutableCache[str, tuple[Step, ...]] = ImmutableCache(1024)
_orders: ImmutableCache[tuple[str, tuple[str, ...], bool], tuple[Step, ...]] = ImmutableCache(256)
"""Procedures by study version, order of conditions, and whether limbs are exchanged."""


def plan_of(db: Session, session: StudySession) -> tuple[Step, ...]:
    """Return the procedure of a session: its protocol in the session's order of conditions.

    A session's version and slot never change, so neither does its plan, which is cached.
    """
    return _plans.get(db, session.id, lambda: read_plan(db, session))


def read_plan(db: Session, session: StudySession) -> tuple[Step, ...]:
    """Return the procedure of a session without the cache, for rows that were just replaced.

    Raises sqlalchemy.exc.NoResultFound without a slot, DamagedValue without a study version, and
    ConfigError or PlanError if the stored texts are not a study or not an order of its conditions.
    """
    version = referenced_row(db, StudyVersion, session.study_version_id)
    slot = slot_of(db, session)
    texts = version.content_hash, version.canonical_json
    return _compiled(*texts, tuple(slot.sequence), slot.position % 2 == 1)


def plans_of(db: Session, chosen: ColumnElement[bool]) -> dict[str, tuple[Step, ...]]:
    """Return the procedures of all `chosen` sessions by session id, with one query.

    Raises sqlalchemy.exc.NoResultFound if one of them has no slot.
    """
    rows = db.execute(
        select(
            StudySession.id,
            StudySession.study_version_id,
            LedgerSlot.sequence,
            LedgerSlot.position,
        )
        .outerjoin(SlotAttempt, SlotAttempt.session_id == StudySession.id)
        .outerjoin(LedgerSlot, LedgerSlot.id == SlotAttempt.slot_id)
        .where(chosen)
    )
    # Many sessions share few orders.
    shared: dict[tuple[str, tuple[str, ...], bool], tuple[Step, ...]] = {}
    plans = {}
    for session_id, version_id, sequence, position in rows:
        if sequence is None:
            raise NoResultFound(f"session {session_id} has no slot of the ledger")
        order = (version_id, tuple(sequence), position % 2 == 1)
        if order not in shared:
            shared[order] = _orders.get(db, order, partial(_ordered, db, *order))
        plans[session_id] = shared[order]
    return plans


def _ordered(
    db: Session,
    version_id: str,
    sequence: tuple[str, ...],
    flip: bool,  # noqa: FBT001 - part of a cache key
) -> tuple[Step, ...]:
    return compile_plan(version_content(db, version_id).protocol, sequence, block_limb_flip=flip)


@lru_cache(maxsize=256)
def _compiled(
    content_hash: str,
    canonical_json: str,
    sequence: tuple[str, ...],
    flip: bool,  # noqa: FBT001 - a cache key
) -> tuple[Step, ...]:
    with unpacking(canonical_json, content_hash):
        protocol = parse_study_json(canonical_json)
    return compile_plan(protocol, sequence, block_limb_flip=flip)


MAX_TIME_SCALE = 100.0
_OTHER_LANGUAGE = "Choose one of the languages of the study."


@dataclass(frozen=True)
class Applied:
    """The result of a command; `events` is empty if it was a repetition or changed nothing."""

    session: StudySession
    state: SessionState
    events: tuple[object, ...]


def protocol_of_session(db: Session, session: StudySession) -> StudyProtocol:
    """Return the protocol of the study version that this session follows."""
    return version_content(db, session.study_version_id).protocol


def choose_language(db: Session, context: AppContext, session: StudySession, language: str) -> None:
    """Switch a locked session to another language of its study; raise InvalidInput if it is not.

    The language of a session that has ended is that in which it was held: raises NotNow.
    """
    valid = protocol_of_session(db, session).languages
    if language not in valid:
        raise InvalidInput(
            f"the study has no texts in {language!r}",
            value=language,
            valid=list(valid),
            remedy=_OTHER_LANGUAGE,
        )
    if language == session.language:
        return
    require_running(db, session, "nobody reads its texts any more")
    session.language = language
    context.hub.publish_after_commit(db, session.id)


def state_of(session: StudySession) -> SessionState:
    """Return the current state of a session, from its snapshot."""
    return state_from_json(session.snapshot)


def folded(log: Iterable[SessionEvent], steps: int) -> SessionState:
    """Fold a whole log into a state, from the first event on; the plan has `steps` steps.

    Raises KeyError for an event of an unknown type, ValueError for a payload that does not match
    its type, and IndexError for a step that does not exist.
    """
    return reduce(evolve, map(event_of, log), initial_state(steps))


def join(
    db: Session,
    context: AppContext,
    *,
    study_key: str,
    participant_code: str | None,
    kind: str,
    language: str,
    time_scale: float = 1.0,
    request_id: str | None = None,
) -> StudySession:
    """Create a session on the next slot of the ledger, or return that of a repeated `request_id`.

    `time_scale` is how many seconds of the client's clock pass per real second; only simulated
    sessions may set it. Raises InvalidInput, NotFound, Conflict or NotDurable.
    """
    context.storage.require_storage()
    study = study_by_key(db, study_key)
    wish = _Wish(request_id, participant_code, kind, language, time_scale)
    made = _made_before(db, study, wish)
    if made is not None:
        return made
    require_open(study)
    version = newest_version(db, study)
    protocol = protocol_of(version)
    _check_join(protocol, kind, language, time_scale)
    now = context.clock.utc_now()
    # Lock the ledger first, since simultaneous joins queue on it.
    slot = take_slot(db, version, protocol, kind, now)
    made = _made_before(db, study, wish)
    if made is not None:
        return made
    participant = find_or_add_participant(
        db, study_id=study.id, kind=kind, code=participant_code, now=now
    )
    session = StudySession(
        id=new_id(),
        study_id=study.id,
        study_version_id=version.id,
        participant_id=participant.id,
        kind=kind,
        avatar=protocol.avatar,
        avatar_configuration_hash=_avatar_hash(db, protocol),
        language=language,
        time_scale=time_scale,
        seed=secrets.randbits(48),
        status="planned",
        version=0,
        snapshot={},
        request_id=request_id,
        created_at=now,
    )
    db.add(session)
    db.flush()
    open_attempt(db, slot, session, now)
    session.snapshot = state_to_json(initial_state(len(plan_of(db, session))))
    db.flush()
    return session


class _Wish(NamedTuple):
    """What a client asked for when it asked for a session."""

    request_id: str | None
    participant_code: str | None
    kind: str
    language: str
    time_scale: float


def _made_before(db: Session, study: Study, wish: _Wish) -> StudySession | None:
    """Return the session that a request with the same id has already created, if there is one.

    Raises Conflict if it asked for another one than this request does.
    """
    if wish.request_id is None:
        return None
    session = db.scalar(select(StudySession).where(StudySession.request_id == wish.request_id))
    if session is None:
        return None
    code = referenced_row(db, Participant, session.participant_id).code
    asked = ((wish.participant_code or "").strip() or code, wish.kind, wish.language)
    made = (code, session.kind, session.language)
    if session.study_id != study.id or made != asked or session.time_scale != wish.time_scale:
        raise Conflict(
            f"this request has already created the session of {code}, and asks for another one now",
            value=asked[0],
            valid=code,
            remedy="Open that session; to create another one, start again with a new request.",
            details=[{"session_id": session.id, "status": session.status}],
        )
    return session


def _avatar_hash(db: Session, protocol: StudyProtocol) -> str | None:
    """Return the content hash of the avatar configuration, whose versions are never edited."""
    chosen = protocol.avatar_configuration
    return None if chosen is None else version_of(db, chosen.key, chosen.version).content_hash


def _check_join(protocol: StudyProtocol, kind: str, language: str, time_scale: float) -> None:
    if kind not in KINDS:
        raise InvalidInput(
            f"unknown kind {kind!r}",
            value=kind,
            valid=list(KINDS),
            remedy="Name one of these kinds.",
        )
    if language not in protocol.languages:
        raise InvalidInput(
            f"the study has no texts in {language!r}",
            value=language,
            valid=list(protocol.languages),
            remedy=_OTHER_LANGUAGE,
        )
    if not 0 < time_scale <= MAX_TIME_SCALE:
        raise InvalidInput(
            "time_scale is out of range",
            value=time_scale,
            valid=f"above 0, at most {MAX_TIME_SCALE}",
            remedy="Give a number in that range, or leave time_scale out for real time.",
        )
    if time_scale != 1.0 and kind != "simulated":
        raise InvalidInput(
            "only simulated sessions may run at another speed than real time",
            value=time_scale,
            valid=1.0,
            remedy="Leave time_scale out, or make the session simulated.",
        )


def apply_command(
    db: Session,
    context: AppContext,
    session: StudySession,
    command: Command,
    *,
    actor: str,
    command_id: str | None = None,
    expected_version: int | None = None,
) -> Applied:
    """Decide a command and record its events. `session` must have been read with `lock=True`.

    A repeated `command_id` changes nothing. `expected_version` is the version that the caller saw:
    if the session has changed since, StaleVersion lists the events since then. Raises NotNow if the
    command cannot be carried out in the current state.
    """
    state = state_of(session)
    if command_id is not None and is_repeated(db, session.id, command_id):
        return Applied(session, state, ())
    if expected_version is not None and expected_version != session.version:
        raise _stale(db, session, expected_version)
    plan = plan_of(db, session)
    try:
        events = decide(plan, state, command)
    except Refused as refusal:
        raise NotNow(
            refusal.message, value=refusal.value, valid=refusal.valid, remedy=refusal.remedy
        ) from refusal
    if not events:
        return Applied(session, state, ())
    events = with_active_time(db, session.id, plan, state, events)
    append_events(
        db,
        session_id=session.id,
        version=session.version,
        events=events,
        actor=actor,
        command_id=command_id,
        clock=context.clock,
    )
    now = context.clock.utc_now()
    for event in events:
        state = evolve(state, event)
        project(db, session, plan, event, now)
    session.version = state.version
    session.status = str(state.status)
    session.snapshot = state_to_json(state)
    db.flush()
    if any(isinstance(event, SessionEnded) for event in events):
        settle_validity(db, session, plan, state)
        db.flush()
    context.hub.publish_after_commit(db, session.id)
    return Applied(session, state, tuple(events))


def judge_again(db: Session, session: StudySession, doubted: Collection[int | None]) -> None:
    """Decide again whether a session is valid, after a latency was measured or data were doubted.

    `doubted`: phases for which the headset reported something that cannot be true; None stands for
    the whole session.
    """
    settle_validity(db, session, plan_of(db, session), state_of(session), doubted)


def is_repeated(db: Session, session_id: str, command_id: str) -> bool:
    """Return whether this command was applied before, so that resending it changes nothing."""
    query = select(SessionEvent.seq).where(
        SessionEvent.session_id == session_id, SessionEvent.command_id == command_id
    )
    return db.scalar(query.limit(1)) is not None


def _stale(db: Session, session: StudySession, expected_version: int) -> StaleVersion:
    since = db.scalars(
        select(SessionEvent)
        .where(SessionEvent.session_id == session.id, SessionEvent.seq > expected_version)
        .order_by(SessionEvent.seq)
    )
    details = [
        {"seq": row.seq, "type": row.type, "actor": row.actor, "at": row.recorded_at.isoformat()}
        for row in since
    ]
    return StaleVersion(
        "the session has changed since this page was loaded",
        value=expected_version,
        valid=session.version,
        remedy="Review what changed, then decide again. Nothing was done.",
        details=details,
    )
