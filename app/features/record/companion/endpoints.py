"""Endpoints of a session's companion."""

from fastapi import APIRouter, WebSocket
from sqlalchemy.orm import Session
from starlette.concurrency import run_in_threadpool

from app.errors import InvalidInput, NotFound
from app.features.movement.humanoids import humanoid_by_hash
from app.features.movement.performers import reference_body
from app.features.record.companion.placing import standing_at
from app.features.record.companion.schemas import CompanionChoice, CompanionWish, SessionCompanion
from app.features.record.companion.service import Companions
from app.features.record.companion.socket import CompanionSocket
from app.features.record.companion.view import session_companion
from app.features.record.headset import serve_headset
from app.features.record.sessions import (
    ChooseCompanion,
    Companion,
    apply_command,
    protocol_of_session,
)
from app.models import StudySession
from app.platform.access import session_by_id
from app.platform.dependencies import Context, Reading, SignedIn, write
from app.science.retargeting import AvatarError

router = APIRouter(tags=["companion"])
STATURES = "50cm to 260cm"


@router.websocket("/vr/companion")
async def vr_companion(socket: WebSocket) -> None:
    """Show the session's companion in its headset; see docs/protocol.md."""
    await serve_headset(socket, CompanionSocket)


@router.get("/sessions/{session_id}/companion")
def get_session_companion(
    session_id: str, db: Reading, context: Context, _: SignedIn
) -> SessionCompanion:
    """Return whom the participant of a session is shown, and how that goes."""
    return session_companion(db, context, session_by_id(db, session_id))


@router.put("/sessions/{session_id}/companion")
async def put_session_companion(
    session_id: str, body: CompanionChoice, context: Context, caller: SignedIn
) -> SessionCompanion:
    """Show a performer to the participant as another person, or nobody; it is on the record."""

    def choose(db: Session) -> None:
        session = session_by_id(db, session_id, lock=True)
        wish = body.companion
        companion = None if wish is None else _companion(db, session, wish)
        command = ChooseCompanion(companion=companion)
        apply_command(db, context, session, command, actor=caller.actor)

    def shown() -> SessionCompanion:
        context.part(Companions).follow(session_id)
        with context.database.reading() as db:
            return session_companion(db, context, session_by_id(db, session_id))

    await write(context, choose)
    return await run_in_threadpool(shown)


def _companion(db: Session, session: StudySession, wish: CompanionWish) -> Companion:
    """Return a companion with their place; raises InvalidInput for a body that does not exist."""
    try:
        reference_body(wish.stature)
    except AvatarError:
        raise InvalidInput(
            f"nobody is {wish.stature} tall",
            value=wish.stature,
            valid=STATURES,
            remedy="Give the companion's height in centimetres, such as 175cm.",
        ) from None
    if wish.humanoid is not None:
        try:
            # Locked, so that nobody removes the body before it is on the record.
            humanoid_by_hash(db, wish.humanoid, lock=True)
        except NotFound:
            raise InvalidInput(
                "there is no such body in this lab",
                value=wish.humanoid,
                remedy="Choose one of the page Bodies, or null for a plain body.",
            ) from None
    layouts = protocol_of_session(db, session).tasks.layouts()
    standing = standing_at(wish.place, layouts.values())
    return Companion(
        **wish.model_dump(), position_m=standing.position_m, heading_rad=standing.heading_rad
    )
