"""The pre-flight over HTTP."""

from typing import Annotated

from fastapi import APIRouter, Depends

from app.features.record.preflight.schemas import Check, OverrideRequest, Preflight
from app.features.record.preflight.service import override, preflight_of
from app.platform.dependencies import Context, SignedIn, Writing

router = APIRouter(prefix="/sessions/{session_id}/preflight", tags=["preflight"])


@router.get("")
async def get_preflight(session_id: str, context: Context, _: SignedIn) -> Preflight:
    """Every check, made now: devices, signal, storage, latency, and the study's content.

    It writes 64 kB to the database and to the data folder, reads them back and removes them.
    """
    return await preflight_of(context, session_id)


async def _before(session_id: str, context: Context, _: SignedIn) -> Preflight:
    """The list as it is before anything is written: the checks need transactions of their own."""
    return await preflight_of(context, session_id)


@router.post("/overrides", status_code=201)
def post_override(
    session_id: str,
    wish: OverrideRequest,
    before: Annotated[Preflight, Depends(_before)],
    db: Writing,
    context: Context,
    caller: SignedIn,
) -> Check:
    """Go on although a check is not green, for a reason that goes on record."""
    found = next(check for check in before.checks if check.key == wish.check)
    return override(db, context, session_id, wish, found, caller.actor)
