"""HTTP endpoints for the pre-flight checks."""

from typing import Annotated

from fastapi import APIRouter, Depends

from app.features.record.preflight.schemas import Check, OverrideRequest, Preflight
from app.features.record.preflight.service import override, preflight_of
from app.platform.dependencies import Context, SignedIn, Writing

router = APIRouter(prefix="/sessions/{session_id}/preflight", tags=["preflight"])


@router.get("")
async def get_preflight(session_id: str, context: Context, _: SignedIn) -> Preflight:
    """Run all pre-flight checks: devices, signal, storage, latency, and the study's content.

    This writes 64 kB to the database and to the data folder, reads them back and removes them.
    """
    return await preflight_of(context, session_id)


async def _before(session_id: str, context: Context, _: SignedIn) -> Preflight:
    """Run the checks before the request's write transaction, since they open their own."""
    return await preflight_of(context, session_id)


@router.post("/overrides", status_code=201)
def post_override(
    session_id: str,
    request: OverrideRequest,
    before: Annotated[Preflight, Depends(_before)],
    db: Writing,
    context: Context,
    caller: SignedIn,
) -> Check:
    """Record that the session proceeds although a check is not green, and why."""
    found = next(check for check in before.checks if check.key == request.check)
    return override(db, context, session_id, request, found, caller.actor)
