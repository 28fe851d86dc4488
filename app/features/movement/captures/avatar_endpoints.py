"""HTTP endpoints of joint maps and of captures retargeted to avatars."""

import os
import tempfile
from pathlib import Path
from typing import Annotated

from fastapi import APIRouter, Query, Response
from fastapi.responses import FileResponse
from starlette.background import BackgroundTask
from starlette.concurrency import run_in_threadpool

from app.adapters.captures import WRITERS, writer_of
from app.features.movement.captures.capture_queue import CaptureQueue
from app.features.movement.captures.joint_maps import (
    joint_map_view,
    mapped_capture,
    reset_map,
    save_map,
)
from app.features.movement.captures.opening import Mapped
from app.features.movement.captures.schemas import (
    MAX_AVATARS,
    Avatar,
    ExportFormat,
    JointMapView,
    JointMapWish,
    VerificationView,
)
from app.features.movement.captures.worker_tasks import (
    generated_verification_json,
    retargeted_positions,
    verification_json,
    write_retargeted,
)
from app.features.movement.files import BINARY, BYTES, attachment, binary
from app.platform.context import AppContext
from app.platform.dependencies import Context, Reading, SignedIn, Writing
from app.platform.incomplete_files import uploads_of

router = APIRouter(prefix="/captures", tags=["captures"])
WRITTEN = " or ".join(one.name.en for one in WRITERS)


@router.get("/{capture_id}/joint-map")
def get_joint_map(capture_id: str, db: Reading, _: SignedIn) -> JointMapView:
    """Return the joint map of the capture's skeleton: the saved one, else the proposal."""
    return joint_map_view(db, capture_id)


@router.put("/{capture_id}/joint-map")
def put_joint_map(
    capture_id: str, request: JointMapWish, db: Writing, context: Context, caller: SignedIn
) -> JointMapView:
    """Save a joint map for every capture of this skeleton, as a new version."""
    save_map(db, context, caller, capture_id, request)
    return joint_map_view(db, capture_id)


@router.delete("/{capture_id}/joint-map")
def delete_joint_map(
    capture_id: str,
    db: Writing,
    context: Context,
    caller: SignedIn,
    version: Annotated[int, Query(ge=0, le=2**31 - 1)],
) -> JointMapView:
    """Reset the joint map to the proposal, as a new version."""
    reset_map(db, context, caller, capture_id, version)
    return joint_map_view(db, capture_id)


@router.get("/generated/verification", response_model=VerificationView)
async def get_generated_verification(
    context: Context,
    _: SignedIn,
    *,
    avatars: Annotated[list[Avatar], Query(min_length=1, max_length=MAX_AVATARS)],
    lock_feet: bool = False,
) -> Response:
    """Return the verification of a generated walk of eight steps, which needs no capture."""
    statures = tuple(dict.fromkeys(avatars))
    return Response(
        await context.part(CaptureQueue).run_cached(
            generated_verification_json, statures, lock_feet=lock_feet
        ),
        media_type="application/json",
    )


@router.get("/{capture_id}/verification", response_model=VerificationView)
async def get_verification(
    capture_id: str,
    context: Context,
    _: SignedIn,
    *,
    avatars: Annotated[list[Avatar], Query(min_length=1, max_length=MAX_AVATARS)],
    lock_feet: bool = False,
) -> Response:
    """Return whether the movement keeps its characteristics on avatars of these statures."""
    mapped = await run_in_threadpool(mapped_capture, context, capture_id)
    statures = tuple(dict.fromkeys(avatars))
    return Response(
        await context.part(CaptureQueue).run_cached(
            verification_json, mapped, statures, lock_feet=lock_feet
        ),
        media_type="application/json",
    )


@router.get(
    "/{capture_id}/retargeted",
    response_class=FileResponse,
    responses={
        200: {
            "content": {one.media_type: BINARY for one in WRITERS},
            "description": f"The movement on the avatar, as a {WRITTEN} file.",
        }
    },
)
async def get_retargeted(
    capture_id: str,
    context: Context,
    _: SignedIn,
    *,
    avatar: Avatar,
    format: ExportFormat = WRITERS[0].key,  # noqa: A002 - the word of the address
    lock_feet: bool = False,
) -> FileResponse:
    """Download the movement on an avatar as a file."""
    mapped = await run_in_threadpool(mapped_capture, context, capture_id)
    path = await _retargeted_file(context, mapped, avatar, format, lock_feet=lock_feet)
    return FileResponse(
        path,
        media_type=writer_of(format).media_type,
        headers=attachment(f"{Path(mapped.source.name).stem}-{avatar}{writer_of(format).suffix}"),
        background=BackgroundTask(path.unlink),
    )


@router.get(
    "/{capture_id}/retargeted-motion",
    response_class=Response,
    responses={200: binary("Positions of the avatar's joints, in the form of `motion`.")},
)
async def get_retargeted_motion(
    capture_id: str,
    context: Context,
    _: SignedIn,
    *,
    avatar: Avatar,
    lock_feet: bool = False,
    rotations: bool = False,
) -> Response:
    """Return the positions of an avatar's joints over time, for a preview.

    `rotations`: also the joints' rotations, which are needed to draw a body with skin.
    """
    mapped = await run_in_threadpool(mapped_capture, context, capture_id)
    return Response(
        await context.part(CaptureQueue).run_cached(
            retargeted_positions, mapped, avatar, lock_feet=lock_feet, rotations=rotations
        ),
        media_type=BYTES,
    )


async def _retargeted_file(
    context: AppContext, mapped: Mapped, avatar: str, format_: ExportFormat, *, lock_feet: bool
) -> Path:
    """Write the movement on an avatar to a file that the caller removes; raise InvalidInput."""
    path = await run_in_threadpool(_new_file, context)
    try:
        await context.part(CaptureQueue).run(
            write_retargeted, mapped, avatar, format_, path, lock_feet=lock_feet
        )
    except BaseException:
        await run_in_threadpool(path.unlink)
        raise
    return path


def _new_file(context: AppContext) -> Path:
    handle, name = tempfile.mkstemp(prefix="retargeted-", dir=uploads_of(context.settings))
    os.close(handle)
    return Path(name)
