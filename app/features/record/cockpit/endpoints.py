"""HTTP endpoints for sessions: creating them, the cockpit's view, commands, events, and answers."""

from fastapi import APIRouter, Response
from pydantic import TypeAdapter
from sqlalchemy import select

from app.errors import Conflict
from app.features.design.studies import study_by_key
from app.features.record.cockpit.avatar_changes import AvatarChoices, avatar_choices
from app.features.record.cockpit.commands import command_of, require_reason
from app.features.record.cockpit.schemas import (
    NEVER_STALE,
    CommandRequest,
    EventView,
    ListedSession,
    NewSession,
    Reveal,
    SessionView,
    StreamView,
)
from app.features.record.cockpit.view import event_views, list_sessions, session_view
from app.features.record.doubts import judge_with_doubts
from app.features.record.ledger import Kind
from app.features.record.questionnaires import (
    Administration,
    Receipt,
    StoredAnswers,
    SubmissionRequest,
    current_administration,
    stored_answers,
    submit,
)
from app.features.record.sessions import (
    ConsentRecord,
    LiftBlinding,
    apply_command,
    consent_record,
    is_repeated,
    join,
    protocol_of_session,
    state_of,
    store_content,
)
from app.models import TelemetryStream
from app.platform.access import is_blind, session_by_id
from app.platform.dependencies import Context, Reading, SignedIn, Writing
from app.wire import PARTICIPANT_STREAMS, REPORT_STREAM

router = APIRouter(tags=["sessions"])
_LISTED = TypeAdapter(list[ListedSession])


@router.post("/studies/{key}/sessions", status_code=201)
def create_session(
    key: str, request: NewSession, db: Writing, context: Context, caller: SignedIn
) -> SessionView:
    """Create a session of a study, which takes the next slot of the ledger.

    A repeated `request_id` returns the session that the first request created.
    """
    session = join(
        db,
        context,
        study_key=key,
        participant_code=request.participant_code,
        kind=request.kind,
        language=request.language,
        time_scale=request.time_scale,
        request_id=request.request_id,
    )
    return session_view(db, context, session, caller)


@router.get("/studies/{key}/sessions", response_model=list[ListedSession])
def get_sessions(key: str, db: Reading, caller: SignedIn, kind: Kind | None = None) -> Response:
    """Return the sessions of a study, newest first."""
    listed = list_sessions(db, study_by_key(db, key), kind, caller)
    # Serialised here, because otherwise the event loop would first validate a thousand once more.
    return Response(_LISTED.dump_json(listed), media_type="application/json")


@router.get("/sessions/{session_id}")
def get_session(session_id: str, db: Reading, context: Context, caller: SignedIn) -> SessionView:
    """Return a session as the cockpit shows it."""
    return session_view(db, context, session_by_id(db, session_id), caller)


@router.post("/sessions/{session_id}/commands")
def post_command(
    session_id: str, request: CommandRequest, db: Writing, context: Context, caller: SignedIn
) -> SessionView:
    """Apply a command to a session. A repeated `command_id` changes nothing.

    A command that was decided on an older version of the session is rejected as stale, unless it is
    a note or stops something.
    """
    session = session_by_id(db, session_id, lock=True)
    if is_repeated(db, session_id, request.command_id):
        return session_view(db, context, session, caller)
    apply_command(
        db,
        context,
        session,
        command_of(db, context, session, request, caller.actor),
        actor=caller.actor,
        command_id=request.command_id,
        expected_version=None if request.type in NEVER_STALE else request.expected_version,
    )
    judge_with_doubts(db, session)
    return session_view(db, context, session, caller)


@router.get("/sessions/{session_id}/avatar-choices")
def get_avatar_choices(session_id: str, db: Reading, _: SignedIn) -> AvatarChoices:
    """Return what an operator can change about a session's avatar while it runs."""
    return avatar_choices(db, session_by_id(db, session_id))


@router.get("/sessions/{session_id}/events")
def get_events(session_id: str, db: Reading, caller: SignedIn) -> list[EventView]:
    """Return the event log of a session, oldest first."""
    return event_views(db, session_by_id(db, session_id), caller)


@router.post("/sessions/{session_id}/reveal")
def post_reveal(
    session_id: str, request: Reveal, db: Writing, context: Context, caller: SignedIn
) -> SessionView:
    """Show the condition of a blinded session early, for a reason that is recorded.

    Repeating the request changes nothing. Operators stay blinded. Raises Conflict if another
    session has taken this one's slot, because its condition would be revealed, too.
    """
    session = session_by_id(db, session_id, lock=True)
    reason = require_reason(request.reason, "showing the condition")
    if is_blind(db, caller, protocol_of_session(db, session), session):
        content = store_content(
            db,
            session_id=session.id,
            kind="reason",
            body=reason,
            by=caller.actor,
            now=context.clock.utc_now(),
        )
        apply_command(db, context, session, LiftBlinding(content=content), actor=caller.actor)
        if is_blind(db, caller, protocol_of_session(db, session), session):
            raise Conflict(
                "another session now has this session's slot in the ledger, and so the same order",
                value=session.status,
                remedy="Show the condition of that session instead, or wait until it is completed.",
            )
    return session_view(db, context, session, caller)


@router.get("/sessions/{session_id}/answers")
def get_answers(session_id: str, db: Reading, _: SignedIn) -> list[StoredAnswers]:
    """Return all stored forms of a session with their answers and scores."""
    return stored_answers(db, session_by_id(db, session_id))


@router.get("/sessions/{session_id}/administration")
def get_administration(session_id: str, db: Reading, _: SignedIn) -> Administration | None:
    """Return the form that is due now, for the operator to fill in; null if none is."""
    return current_administration(db, session_by_id(db, session_id))


@router.post("/sessions/{session_id}/submissions")
def post_submission(
    session_id: str, request: SubmissionRequest, db: Writing, context: Context, caller: SignedIn
) -> Receipt:
    """Store a form that the operator filled in with the participant's spoken answers."""
    session = session_by_id(db, session_id, lock=True)
    return submit(db, context, session, request, mode="operator", actor=caller.actor)


@router.get("/sessions/{session_id}/streams")
def get_streams(session_id: str, db: Reading, caller: SignedIn) -> list[StreamView]:
    """Return how much of each stream is on disk, for every epoch of the headset.

    Blinded readers get that of the reports only between phases: a report follows every contact. Of
    the avatar's frames they never get how many are flagged: that depends on its settings.
    """
    session = session_by_id(db, session_id)
    blinded = is_blind(db, caller, protocol_of_session(db, session), session)
    is_hidden = blinded and state_of(session).phase is not None
    shown = (*PARTICIPANT_STREAMS, REPORT_STREAM)
    return [
        StreamView(
            stream=row.stream,
            epoch=row.epoch,
            next_seq=row.next_seq,
            frames_stored=row.frames_stored,
            frames_flagged=None if blinded and row.stream not in shown else row.frames_flagged,
        )
        for row in db.scalars(
            select(TelemetryStream)
            .where(TelemetryStream.session_id == session_id)
            .order_by(TelemetryStream.epoch, TelemetryStream.stream)
        )
        if not (is_hidden and row.stream == REPORT_STREAM)
    ]


@router.get("/sessions/{session_id}/consent")
def get_consent(session_id: str, db: Reading, _: SignedIn) -> ConsentRecord | None:
    """Return the latest consent of a session with everything it covers; null if there is none."""
    return consent_record(db, session_by_id(db, session_id))
