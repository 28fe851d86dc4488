"""HTTP endpoints of pilots: order, watch, stop, resume, delete, and download the record."""

from fastapi import APIRouter, Response
from sqlalchemy.orm import Session
from starlette.concurrency import run_in_threadpool

from app.features.design.studies import require_open, study_by_key
from app.features.results.pilot.pilot_queue import PilotQueue
from app.features.results.pilot.schemas import NewPilot, PilotDefaults, PilotListed, PilotView
from app.features.results.pilot.service import (
    PILOTS,
    check_order,
    follow_pilot,
    order_pilot,
    pilot_defaults,
    pilot_list,
    pilot_of,
    pilot_record,
    pilot_view,
)
from app.platform.context import AppContext
from app.platform.dependencies import FREES_SPACE, Context, Reading, SignedIn, write

router = APIRouter(prefix="/studies/{key}", tags=["pilots"])


@router.get("/pilot-defaults")
def get_pilot_defaults(key: str, db: Reading, caller: SignedIn) -> PilotDefaults:
    """Return what a pilot of the study's newest version starts with."""
    return pilot_defaults(db, key, caller)


@router.get("/pilots")
def get_pilots(key: str, db: Reading, context: Context, _: SignedIn) -> list[PilotListed]:
    """Return the pilots of a study, newest first; everything in them is simulated."""
    return pilot_list(db, context, key)


@router.post("/pilots", status_code=201)
async def post_pilot(key: str, request: NewPilot, context: Context, caller: SignedIn) -> PilotView:
    """Start a pilot; the response is immediate, and its view shows the progress."""
    await run_in_threadpool(_check, context, key, request)
    pilot_id = await write(context, lambda db: order_pilot(db, context, caller, key, request))
    return await run_in_threadpool(follow_pilot, context, key, pilot_id)


def _check(context: AppContext, key: str, request: NewPilot) -> None:
    with context.database.reading() as db:
        check_order(db, key, request)


@router.get("/pilots/{pilot_id}")
def get_pilot(key: str, pilot_id: str, db: Reading, context: Context, _: SignedIn) -> PilotView:
    """Return one pilot: how far it is, or its figures."""
    return pilot_view(db, context, key, pilot_id)


@router.delete("/pilots/{pilot_id}", status_code=204, dependencies=[FREES_SPACE])
async def delete_pilot(key: str, pilot_id: str, context: Context, caller: SignedIn) -> None:
    """Delete a pilot with everything in it, or cancel it."""

    def remove(db: Session) -> None:
        pilot_of(db, key, pilot_id)
        PILOTS.remove(db, context, caller, pilot_id)

    await write(context, remove)
    await run_in_threadpool(context.part(PilotQueue).forget, pilot_id)


@router.post("/pilots/{pilot_id}/stop")
async def stop_pilot(key: str, pilot_id: str, context: Context, caller: SignedIn) -> PilotView:
    """Stop a pilot; what it has finished is kept."""

    def stop(db: Session) -> None:
        pilot_of(db, key, pilot_id)
        PILOTS.stop(db, context, caller, pilot_id)

    await write(context, stop)
    return await run_in_threadpool(follow_pilot, context, key, pilot_id)


@router.post("/pilots/{pilot_id}/resume")
async def resume_pilot(key: str, pilot_id: str, context: Context, caller: SignedIn) -> PilotView:
    """Resume a stopped pilot, or retry a failed one; the result is as if it had not stopped."""

    def resume(db: Session) -> None:
        pilot_of(db, key, pilot_id)
        require_open(study_by_key(db, key))
        PILOTS.resume(db, context, caller, pilot_id)

    await write(context, resume)
    return await run_in_threadpool(follow_pilot, context, key, pilot_id)


@router.get(
    "/pilots/{pilot_id}/record",
    response_class=Response,
    responses={200: {"content": {"application/jsonl": {}}, "description": "The record."}},
)
def get_pilot_record(key: str, pilot_id: str, db: Reading, _: SignedIn) -> Response:
    """Return every simulated visit or part as `reembody pilot --out` writes it."""
    row, record = pilot_record(db, key, pilot_id)
    name = f"{key}_pilot_{row.kind}_seed{row.options['seed']}_simulated.jsonl"
    return Response(
        record.encode(),
        media_type="application/jsonl",
        headers={"content-disposition": f'attachment; filename="{name}"'},
    )
