"""Sessions over HTTP: joining, the cockpit's view, commands, the log, live news."""

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated, Any

from fastapi import APIRouter, Depends
from fastapi.sse import EventSourceResponse, ServerSentEvent
from sqlalchemy import select

from app.features.context import AppContext
from app.features.dependencies import Context, Reading, SignedIn, Writing
from app.features.questionnaires.schemas import (
    Administration,
    Receipt,
    StoredAnswers,
    SubmissionRequest,
)
from app.features.questionnaires.service import current_administration, stored_answers, submit
from app.features.sessions.commands import command_of
from app.features.sessions.schemas import (
    CommandRequest,
    EventView,
    Kind,
    NewSession,
    SessionSummary,
    SessionView,
    StreamView,
)
from app.features.sessions.service import (
    apply_command,
    is_repeated,
    join,
    protocol_of_session,
    session_by_id,
)
from app.features.sessions.view import event_views, list_sessions, session_view
from app.features.studies.service import study_by_key
from app.models import TelemetryStream

router = APIRouter(tags=["sessions"])
HEARTBEAT_S = 10.0


def _known_session(session_id: str, context: Context) -> str:
    """The id of a session that exists: a stream cannot say otherwise once it has begun."""
    with context.database.reading() as db:
        return session_by_id(db, session_id).id


KnownSession = Annotated[str, Depends(_known_session)]


@router.post("/studies/{key}/sessions", status_code=201)
def create_session(
    key: str, request: NewSession, db: Writing, context: Context, _: SignedIn
) -> SessionView:
    """Join a study: take the next slot of the ledger for a participant."""
    session = join(
        db,
        context,
        study_key=key,
        participant_code=request.participant_code,
        kind=request.kind,
        language=request.language,
        time_scale=request.time_scale,
    )
    return session_view(db, context, session)


@router.get("/studies/{key}/sessions")
def get_sessions(
    key: str, db: Reading, _: SignedIn, kind: Kind | None = None
) -> list[SessionSummary]:
    """The sessions of a study, newest first."""
    return list_sessions(db, study_by_key(db, key), kind)


@router.get("/sessions/{session_id}")
def get_session(session_id: str, db: Reading, context: Context, _: SignedIn) -> SessionView:
    """A session as the cockpit shows it."""
    return session_view(db, context, session_by_id(db, session_id))


@router.post("/sessions/{session_id}/commands")
def post_command(
    session_id: str, request: CommandRequest, db: Writing, context: Context, caller: SignedIn
) -> SessionView:
    """Do something with a session. A repeated `command_id` changes nothing."""
    session = session_by_id(db, session_id, lock=True)
    if is_repeated(db, session_id, request.command_id):
        return session_view(db, context, session)
    apply_command(
        db,
        context,
        session,
        command_of(db, context, session, request, caller.actor),
        actor=caller.actor,
        command_id=request.command_id,
        # A note cannot clash with anything.
        expected_version=None if request.type == "note" else request.expected_version,
    )
    return session_view(db, context, session)


@router.get("/sessions/{session_id}/events")
def get_events(session_id: str, db: Reading, _: SignedIn) -> list[EventView]:
    """The event log, oldest first."""
    return event_views(db, session_by_id(db, session_id))


@router.get("/sessions/{session_id}/answers")
def get_answers(session_id: str, db: Reading, _: SignedIn) -> list[StoredAnswers]:
    """Every stored form with answers and scores."""
    return stored_answers(db, session_by_id(db, session_id))


@router.get("/sessions/{session_id}/administration")
def get_administration(session_id: str, db: Reading, _: SignedIn) -> Administration | None:
    """The form that is due now, for entry by the operator."""
    return current_administration(db, session_by_id(db, session_id))


@router.post("/sessions/{session_id}/submissions")
def post_submission(
    session_id: str, request: SubmissionRequest, db: Writing, context: Context, caller: SignedIn
) -> Receipt:
    """Store a form that the operator filled in from what the participant said."""
    session = session_by_id(db, session_id, lock=True)
    submission, duplicate = submit(
        db, context, session, request, mode="operator", actor=caller.actor
    )
    return Receipt(receipt_id=submission.id, stored_at=submission.submitted_at, duplicate=duplicate)


@router.get("/sessions/{session_id}/streams")
def get_streams(session_id: str, db: Reading, _: SignedIn) -> list[StreamView]:
    """How much of each stream of each run of the headset is on disk."""
    session_by_id(db, session_id)
    return [
        StreamView(
            stream=row.stream,
            epoch=row.epoch,
            next_seq=row.next_seq,
            frames_stored=row.frames_stored,
            frames_flagged=row.frames_flagged,
        )
        for row in db.scalars(
            select(TelemetryStream)
            .where(TelemetryStream.session_id == session_id)
            .order_by(TelemetryStream.epoch, TelemetryStream.stream)
        )
    ]


@router.get("/sessions/{session_id}/live", response_class=EventSourceResponse)
async def get_live(
    _: SignedIn, session_id: KnownSession, context: Context
) -> AsyncIterator[ServerSentEvent]:
    """News of a session: `session` on every change, `telemetry` a few times a second, and
    `storage` at first and when the record ceases to be written, or the disk gets low.
    """
    blinded = await asyncio.to_thread(_is_blinded, context, session_id)
    with context.hub.subscribe(session_id, "telemetry") as subscription:
        yield await _session_event(context, session_id)
        told = None
        while True:
            storage = await asyncio.to_thread(context.storage.state)
            if storage != told:
                yield ServerSentEvent(data=storage, event="storage")
                told = storage
            news = await subscription.next(HEARTBEAT_S)
            if not news:
                yield ServerSentEvent(comment="still here")
            if "session" in news:
                yield await _session_event(context, session_id)
            if "telemetry" in news:
                figures = _unblinding_left_out(news["telemetry"]) if blinded else news["telemetry"]
                yield ServerSentEvent(data=figures, event="telemetry")


def _is_blinded(context: AppContext, session_id: str) -> bool:
    with context.database.reading() as db:
        return protocol_of_session(db, session_by_id(db, session_id)).blinding.operator


def _unblinding_left_out(figures: dict[str, Any]) -> dict[str, Any]:
    """Joint errors grow with the latency, so they would tell the condition."""
    return {name: value for name, value in figures.items() if name != "joint_error_deg"}


async def _session_event(context: AppContext, session_id: str) -> ServerSentEvent:
    def read() -> SessionView:
        with context.database.reading() as db:
            return session_view(db, context, session_by_id(db, session_id))

    view = await asyncio.to_thread(read)
    return ServerSentEvent(data=view, event="session", id=str(view.version))
