"""The HTTP endpoint that reports the use of disk space."""

from fastapi import APIRouter

from app.features.care.storage.schemas import StorageView
from app.features.care.storage.service import storage_view
from app.platform.dependencies import Context, Reading, SignedIn

router = APIRouter(tags=["storage"])


@router.get("/storage")
def get_storage(
    db: Reading, context: Context, caller: SignedIn, *, anew: bool = False
) -> StorageView:
    """Return the sizes of tables, folders, disk, studies and the largest sessions.

    Sizes are cached for a minute; `anew` measures again.
    """
    return storage_view(db, context, caller, refresh=anew)
