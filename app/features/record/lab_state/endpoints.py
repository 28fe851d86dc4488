"""HTTP endpoint of the lab's state."""

from datetime import UTC, datetime, timedelta
from typing import Annotated

from fastapi import APIRouter, Query

from app.features.record.lab_state.service import LabState, lab_state
from app.platform.access import visible_to
from app.platform.dependencies import Context, Reading, SignedIn

router = APIRouter(tags=["lab"])
DAY = timedelta(days=1)


@router.get("/lab")
def get_lab(
    db: Reading,
    context: Context,
    caller: SignedIn,
    since: Annotated[datetime | None, Query(description="Where the reader's day begins.")] = None,
) -> LabState:
    """Return the progress of the caller's studies, today's sessions and what needs attention."""
    now = context.clock.utc_now()
    began = now - DAY if since is None else since
    if began.tzinfo is None:
        began = began.replace(tzinfo=UTC)
    return lab_state(db, visible_to(caller), max(began, now - 2 * DAY), now)
