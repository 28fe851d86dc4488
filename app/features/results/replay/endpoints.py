"""HTTP endpoints of replays."""

from typing import Annotated

from fastapi import APIRouter, Header, Path, Response

from app.features.movement.files import BYTES, binary
from app.features.results.replay.replay_queue import ReplayQueue
from app.features.results.replay.schemas import Replay
from app.features.results.replay.service import movement_tag, replayable
from app.features.results.replay.timeline import replay_of
from app.platform.dependencies import Context, Reading, SignedIn

router = APIRouter(prefix="/sessions/{session_id}/phases/{phase_id}", tags=["replay"])
PhaseId = Annotated[int, Path(ge=0, lt=2**31)]


@router.get("/replay")
def get_replay(session_id: str, phase_id: PhaseId, db: Reading, caller: SignedIn) -> Replay:
    """Return the replay of a phase that is over, in the phase's time, without its movement."""
    return replay_of(db, replayable(db, caller, session_id, phase_id))


@router.get(
    "/movement",
    response_class=Response,
    responses={
        200: binary("Places of the joints over time."),
        304: {"description": "The movement has not changed."},
    },
)
def get_movement(
    session_id: str,
    phase_id: PhaseId,
    context: Context,
    caller: SignedIn,
    *,
    rotations: bool = False,
    if_none_match: Annotated[str | None, Header(max_length=400)] = None,
) -> Response:
    """Return the positions of the joints of participant and avatar over time.

    `rotations`: also the joints' rotations, which are needed to draw a body with skin.
    """
    with context.database.reading() as db:
        phase_view = replayable(db, caller, session_id, phase_id)
        tag = movement_tag(db, phase_view)
    # The cache must revalidate, because permissions change with the session's state.
    headers = {"etag": tag, "cache-control": "private, no-cache"}
    if if_none_match is not None and tag in if_none_match:
        return Response(status_code=304, headers=headers)
    body = context.part(ReplayQueue).movement(
        session_id, phase_id, full=phase_view.full, rotations=rotations
    )
    return Response(body, media_type=BYTES, headers=headers)
