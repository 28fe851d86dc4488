"""HTTP endpoints of bodies, which are humanoid models."""

from typing import Annotated

from fastapi import APIRouter, Path, Query, Request, Response
from fastapi.responses import StreamingResponse
from starlette.concurrency import run_in_threadpool

from app.features.movement.files import BODY, BYTES, FileName, attachment, binary, sent
from app.features.movement.humanoids.naming import change_body
from app.features.movement.humanoids.removal import remove_body
from app.features.movement.humanoids.schemas import (
    BindingView,
    BodyChange,
    BodyUse,
    HumanoidPage,
    HumanoidView,
)
from app.features.movement.humanoids.service import humanoid_by_hash, humanoid_page, humanoid_view
from app.features.movement.humanoids.uploading import add_humanoid, measure_again, stored_binding
from app.features.movement.humanoids.use import use_of
from app.platform.context import AppContext
from app.platform.dependencies import Context, Reading, SignedIn, Writing

router = APIRouter(prefix="/humanoids", tags=["humanoids"])
ContentHash = Annotated[str, Path(pattern=r"^[0-9a-f]{64}$")]


@router.post(
    "",
    status_code=201,
    openapi_extra=BODY,
    responses={200: {"model": HumanoidView, "description": "The same content was already stored."}},
)
async def post_humanoid(
    request: Request, response: Response, context: Context, caller: SignedIn, name: FileName
) -> HumanoidView:
    """Store a humanoid model, which is the body of the request: GLB, glTF in one file, or VRM."""
    content_hash, new = await add_humanoid(context, caller, name, request.stream())
    if not new:
        response.status_code = 200
    return await run_in_threadpool(_view, context, content_hash)


@router.get("")
def get_humanoids(
    db: Reading,
    _: SignedIn,
    limit: Annotated[int, Query(ge=1, le=1000)] = 200,
    offset: Annotated[int, Query(ge=0, le=2**31 - 1)] = 0,
) -> HumanoidPage:
    """Return the humanoid models of the lab, newest first."""
    return humanoid_page(db, limit=limit, offset=offset)


@router.get("/{content_hash}")
def get_humanoid(content_hash: ContentHash, db: Reading, _: SignedIn) -> HumanoidView:
    """Return one body: parts it has and lacks, lengths, convex pieces, licence and checks."""
    return humanoid_view(db, content_hash)


@router.get("/{content_hash}/binding", response_model=BindingView)
async def get_humanoid_binding(
    content_hash: ContentHash, context: Context, _: SignedIn
) -> Response:
    """Return how the nodes of a model's file follow the parts of its body, for drawing poses."""
    return Response(
        await stored_binding(context, content_hash),
        media_type="application/json",
        headers={"cache-control": "private, max-age=3600"},
    )


@router.patch("/{content_hash}")
def patch_humanoid(
    content_hash: ContentHash, change: BodyChange, db: Writing, context: Context, caller: SignedIn
) -> HumanoidView:
    """Name a body, which is possible only once, set its title, or confirm terms of its licence."""
    change_body(db, caller.actor, content_hash, change, context.clock.utc_now())
    return humanoid_view(db, content_hash)


@router.delete("/{content_hash}", status_code=204)
def delete_humanoid(
    content_hash: ContentHash, db: Writing, context: Context, caller: SignedIn
) -> None:
    """Delete a body that has no name and that no configuration or tuning uses, and its file."""
    remove_body(db, caller.actor, content_hash, context.clock.utc_now())


@router.post("/{content_hash}/measure")
async def post_measure(
    content_hash: ContentHash, context: Context, caller: SignedIn
) -> HumanoidView:
    """Read licence and counts of a body from its stored file; older releases did not read them."""
    await measure_again(context, caller, content_hash)
    return await run_in_threadpool(_view, context, content_hash)


@router.get("/{content_hash}/use")
def get_humanoid_use(content_hash: ContentHash, db: Reading, caller: SignedIn) -> BodyUse:
    """Return the avatar configurations and the studies that use a body."""
    return use_of(db, caller, content_hash)


@router.get(
    "/{content_hash}/file",
    response_class=StreamingResponse,
    responses={200: binary("The file as it was uploaded.")},
)
def get_humanoid_file(
    content_hash: ContentHash, context: Context, _: SignedIn
) -> StreamingResponse:
    """Download the model's file as it was uploaded."""
    with context.database.reading() as db:
        name = humanoid_by_hash(db, content_hash).file_name
    return StreamingResponse(
        sent(context, content_hash), media_type=BYTES, headers=attachment(name)
    )


def _view(context: AppContext, content_hash: str) -> HumanoidView:
    with context.database.reading() as db:
        return humanoid_view(db, content_hash)
