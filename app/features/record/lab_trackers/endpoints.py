"""Endpoints of the trackers that a session's headset uses."""

from fastapi import APIRouter, WebSocket
from sqlalchemy.orm import Session
from starlette.concurrency import run_in_threadpool

from app.features.movement.live import DoorKey
from app.features.record.headset import serve_headset
from app.features.record.lab_trackers.schemas import (
    SessionBehindDoor,
    SessionTrackers,
    TrackersWish,
)
from app.features.record.lab_trackers.service import LabTrackers
from app.features.record.lab_trackers.socket import TrackerSocket
from app.features.record.lab_trackers.view import session_trackers, sessions_behind
from app.features.record.sessions import ChooseTrackers, apply_command
from app.platform.access import session_by_id
from app.platform.dependencies import Context, Reading, SignedIn, write

router = APIRouter(tags=["trackers"])


@router.websocket("/vr/trackers")
async def vr_trackers(socket: WebSocket) -> None:
    """Bring the session's trackers to its headset; see docs/protocol.md."""
    await serve_headset(socket, TrackerSocket)


@router.get("/trackers/doors/{door}/sessions")
def get_door_sessions(door: DoorKey, db: Reading, _: SignedIn) -> list[SessionBehindDoor]:
    """Return the sessions that are not over and use a source of this door."""
    return sessions_behind(db, door)


@router.get("/sessions/{session_id}/trackers")
def get_session_trackers(
    session_id: str, db: Reading, context: Context, _: SignedIn
) -> SessionTrackers:
    """Return the lab's trackers that a session's headset uses, and how well they are aligned."""
    return session_trackers(db, context, session_by_id(db, session_id))


@router.put("/sessions/{session_id}/trackers")
async def put_session_trackers(
    session_id: str, body: TrackersWish, context: Context, caller: SignedIn
) -> SessionTrackers:
    """Let a session's headset use the trackers of a source, or none; it is on the record."""

    def choose(db: Session) -> None:
        session = session_by_id(db, session_id, lock=True)
        command = ChooseTrackers(door=body.door, source=body.source)
        apply_command(db, context, session, command, actor=caller.actor)

    def shown() -> SessionTrackers:
        context.part(LabTrackers).follow(session_id)
        with context.database.reading() as db:
            return session_trackers(db, context, session_by_id(db, session_id))

    await run_in_threadpool(context.part(LabTrackers).store_now, session_id)
    await write(context, choose)
    return await run_in_threadpool(shown)
