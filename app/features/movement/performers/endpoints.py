"""HTTP endpoints of performers: skeletons that are sent live, and their recordings."""

import asyncio
from collections.abc import AsyncIterator
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Annotated

from anyio.to_thread import run_sync
from fastapi import APIRouter, Query
from pydantic import StringConstraints
from starlette.websockets import WebSocket

from app.features.movement.captures import (
    AVATAR,
    CaptureQueue,
    ReadingChoice,
    UploadOptions,
    add_capture,
)
from app.features.movement.live import DoorKey
from app.features.movement.performers.on_body import GroundKey
from app.features.movement.performers.performer import PerformerName
from app.features.movement.performers.schemas import (
    PerformersView,
    PerformerWish,
    PoseWish,
    RecordingStored,
    RecordingView,
)
from app.features.movement.performers.service import Performers
from app.features.movement.performers.socket import MOST_AHEAD, Watched, serve_watcher
from app.features.movement.performers.views import performers_view, recording_view
from app.features.movement.performers.worker_tasks import write_recording
from app.features.people.audit import record
from app.platform.context import AppContext
from app.platform.dependencies import Context, Reading, SignedIn, Writing
from app.platform.incomplete_files import uploads_of

router = APIRouter(prefix="/trackers", tags=["trackers"])
READ_BYTES = 1 << 20
AvatarOrCapture = Annotated[str, StringConstraints(pattern=rf"{AVATAR}|^[0-9a-f]{{32}}$")]


@router.get("/performers")
def get_performers(db: Reading, context: Context, _: SignedIn) -> PerformersView:
    """Return the skeletons that come through the doors, and the recordings of them."""
    return performers_view(db, context.part(Performers))


@router.post("/performers/pose")
def post_pose(body: PoseWish, db: Writing, context: Context, caller: SignedIn) -> PerformersView:
    """Agree about the pose in which a performer is now, for everybody who watches."""
    performers = context.part(Performers)
    performers.agree(body.name, body.pose)
    name = body.name
    record(
        db,
        actor=caller.actor,
        action="performer.agreed",
        subject=name.source,
        details={"door": name.door, "performer": name.skeleton or name.source, "pose": body.pose},
        now=context.clock.utc_now(),
    )
    return performers_view(db, performers)


@router.post("/recordings", status_code=201)
def post_recording(body: PerformerWish, context: Context, caller: SignedIn) -> RecordingView:
    """Begin to record a performer's own movement; it is kept in memory until it is stored."""
    return recording_view(context.part(Performers).record(body.name, caller.actor))


@router.post("/recordings/{recording_id}/capture", status_code=201)
async def post_recorded_capture(
    recording_id: str, context: Context, caller: SignedIn
) -> RecordingStored:
    """End a recording and store it as a capture, a BVH file at a constant rate.

    If that fails, the recording stays and can be stored again.
    """
    performers = context.part(Performers)
    recording, recorded = await run_sync(performers.recorded, recording_id)
    folder = await run_sync(partial(TemporaryDirectory, dir=uploads_of(context.settings)))
    try:
        path = Path(folder.name) / "recording.bvh"
        written = await context.part(CaptureQueue).run(write_recording, recorded, path)
        options = UploadOptions(
            name=file_name(recording.name, recording.since.strftime("%Y-%m-%d %H-%M-%S")),
            companion=None,
            companion_bytes=None,
            reading=ReadingChoice(),
        )
        capture_id, _ = await add_capture(context, caller, options, _pieces(path))
    finally:
        await run_sync(folder.cleanup)
    performers.discard(recording_id)
    return RecordingStored(
        capture_id=capture_id,
        frames=written.frames,
        rate_hz=written.rate_hz,
        duration_s=written.duration_s,
        gaps=list(written.gaps),
        held_share=written.held_share,
    )


@router.delete("/recordings/{recording_id}", status_code=204)
def delete_recording(recording_id: str, context: Context, _: SignedIn) -> None:
    """Discard a recording."""
    context.part(Performers).discard(recording_id)


@router.websocket("/performers/watch")
async def watch_performer(
    socket: WebSocket,
    door: DoorKey,
    source: Annotated[str, Query(min_length=1, max_length=64)],
    skeleton: Annotated[str, Query(max_length=64)] = "",
    avatar: AvatarOrCapture = "165cm",
    ground: GroundKey = "flat",
    ahead: Annotated[int, Query(ge=1, le=MOST_AHEAD)] = 2,
) -> None:
    """Stream a performer's movement on a body; see docs/live.md."""
    context: AppContext = socket.app.state.context
    watched = Watched(PerformerName(door, source, skeleton), avatar, ground, ahead)
    try:
        await serve_watcher(socket, context, watched)
    except asyncio.CancelledError:
        return  # the server stops


def file_name(name: PerformerName, at: str) -> str:
    """Return the name of a recording's file: the source, its skeleton, and when it began (UTC)."""
    who = ", ".join(one for one in (name.source, name.skeleton) if one)
    safe = "".join("_" if one in '/\\<>:"|?*' or not one.isprintable() else one for one in who)
    return f"{safe}, {at} UTC.bvh"


async def _pieces(path: Path) -> AsyncIterator[bytes]:
    with path.open("rb") as file:
        while piece := await run_sync(file.read, READ_BYTES):
            yield piece
