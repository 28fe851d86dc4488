"""HTTP endpoints of avatar configurations: list, save versions, import, export and build models."""

from typing import Annotated

from fastapi import APIRouter, Header, Path, Query, Response

from app.features.movement.avatar.editing import edit, version_difference
from app.features.movement.avatar.schemas import (
    MAX_VERSION,
    AvatarCheck,
    AvatarEdit,
    AvatarEdited,
    AvatarSummary,
    AvatarText,
    AvatarVersionDetail,
    AvatarVersionDifference,
    AvatarView,
    ModelToTry,
    NewAvatar,
    NewAvatarVersion,
)
from app.features.movement.avatar.service import (
    add_avatar_version,
    create_avatar,
    typed,
    version_of,
)
from app.features.movement.avatar.views import (
    MEDIA_TYPE,
    avatar_list,
    avatar_view,
    check_text,
    model_of,
    model_to_try,
    version_detail,
)
from app.platform.dependencies import Context, Reading, SignedIn, Writing
from app.protocol.avatar import avatar_text

router = APIRouter(prefix="/avatars", tags=["avatars"])
Number = Annotated[int, Path(ge=1, le=MAX_VERSION)]


@router.get("")
def get_avatars(db: Reading, caller: SignedIn) -> list[AvatarSummary]:
    """Return every avatar's configuration in its newest version."""
    return avatar_list(db, caller)


@router.post("", status_code=201)
def post_avatar(request: NewAvatar, db: Writing, context: Context, caller: SignedIn) -> AvatarView:
    """Save an avatar configuration under a new key."""
    create_avatar(db, caller.actor, request, context.clock.utc_now())
    return avatar_view(db, caller, request.key)


@router.post("/check")
def post_avatar_check(file: AvatarText, db: Reading, _: SignedIn) -> AvatarCheck:
    """Parse a file without storing it; return its configuration or all problems with places."""
    return check_text(db, file.text)


@router.post("/edit")
def post_avatar_edit(request: AvatarEdit, db: Reading, _: SignedIn) -> AvatarEdited:
    """Apply operations to a configuration without storing it: what changes, and what is lost."""
    return edit(db, request)


@router.post(
    "/model",
    response_class=Response,
    responses={
        200: {
            "content": {MEDIA_TYPE: {"schema": {"type": "string"}}},
            "description": "The model as MJCF; its ETag is the SHA-256 of its bytes.",
        }
    },
)
def post_avatar_model(request: ModelToTry, db: Reading, _: SignedIn) -> Response:
    """Return a configuration that need not be stored as a MuJoCo model; nothing is stored."""
    model = model_to_try(db, request)
    headers = {"etag": f'"{model.content_hash}"', "cache-control": "no-store"}
    return Response(model.mjcf, media_type=MEDIA_TYPE, headers=headers)


@router.get("/{key}")
def get_avatar(key: str, db: Reading, caller: SignedIn) -> AvatarView:
    """Return one avatar with all its versions, the newest one in full."""
    return avatar_view(db, caller, key)


@router.post("/{key}/versions", status_code=201)
def post_avatar_version(
    key: str, request: NewAvatarVersion, db: Writing, context: Context, caller: SignedIn
) -> AvatarView:
    """Append a version to an avatar, unless its content is that of the newest version."""
    add_avatar_version(db, caller.actor, key, request, context.clock.utc_now())
    return avatar_view(db, caller, key)


@router.get("/{key}/versions/{number}")
def get_avatar_version(
    key: str, number: Number, db: Reading, caller: SignedIn
) -> AvatarVersionDetail:
    """Return one version of an avatar configuration in full."""
    return version_detail(db, caller, key, number)


@router.get("/{key}/versions/{number}/difference/{other}")
def get_avatar_difference(
    key: str, number: Number, other: Number, db: Reading, _: SignedIn
) -> AvatarVersionDifference:
    """Return what changed from version `number` to version `other`: by value and by body group."""
    return version_difference(db, key, number, other)


@router.get(
    "/{key}/versions/{number}/file",
    response_class=Response,
    responses={200: {"content": {"application/json": {}}, "description": "The file."}},
)
def get_avatar_file(key: str, number: Number, db: Reading, _: SignedIn) -> Response:
    """Download a version as a JSON file that can be imported again."""
    version = version_of(db, key, number)
    name = f"{version.key}-v{version.number}.json"
    return Response(
        avatar_text(typed(version)),
        media_type="application/json",
        headers={"content-disposition": f'attachment; filename="{name}"'},
    )


@router.get(
    "/{key}/model",
    response_class=Response,
    responses={
        200: {
            "content": {MEDIA_TYPE: {"schema": {"type": "string"}}},
            "description": "The model as MJCF; its ETag is the SHA-256 of its bytes.",
        },
        304: {"description": "The reader has it already."},
    },
)
def get_avatar_model(
    key: str,
    db: Reading,
    _: SignedIn,
    stature_m: Annotated[float, Query(ge=0.5, le=2.6, allow_inf_nan=False)],
    version: Annotated[int | None, Query(ge=1, le=MAX_VERSION)] = None,
    if_none_match: Annotated[str | None, Header(max_length=1_000)] = None,
) -> Response:
    """Return the avatar at a stature as a MuJoCo model; without `version`, the newest version."""
    model = model_of(db, key, version, stature_m)
    tag = f'"{model.content_hash}"'
    headers = {"etag": tag, "cache-control": "private, no-cache"}
    cached_tags = [one.strip().removeprefix("W/") for one in (if_none_match or "").split(",")]
    if tag in cached_tags or "*" in cached_tags:
        return Response(status_code=304, headers=headers)
    return Response(model.mjcf, media_type=MEDIA_TYPE, headers=headers)
