"""The avatar of a session over HTTP, for its headset."""

from fastapi import APIRouter

from app.features.record.headset.avatar import prepare, put_on_record
from app.features.record.headset.avatar_schemas import AvatarWish, SessionAvatar
from app.platform.dependencies import Context, PairedHeadset

router = APIRouter(prefix="/vr", tags=["headset"])


@router.post("/avatar")
def post_avatar(wish: AvatarWish, context: Context, headset: PairedHeadset) -> SessionAvatar:
    """Build the session's physics avatar for this participant and put it on record."""
    context.storage.require_storage()
    with context.database.reading() as db:
        prepared = prepare(db, headset.session_id, wish)
    with context.database.writing() as db:
        put_on_record(db, context, headset.session_id, prepared, f"headset:{headset.id}")
    return prepared.told
