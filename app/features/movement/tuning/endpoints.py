"""HTTP endpoints of tunings: order, watch, stop, resume, look at, compare, accept and save."""

from fastapi import APIRouter
from starlette.concurrency import run_in_threadpool

from app.features.movement.avatar import AvatarView, avatar_view
from app.features.movement.tuning.desk import TuningDesk
from app.features.movement.tuning.finished import (
    accepted_configuration,
    asked_axis,
    asked_comparison,
    save_accepted,
)
from app.features.movement.tuning.schemas import (
    AcceptedAxes,
    AcceptedConfiguration,
    AxisCurvesView,
    ComparisonAsked,
    ComparisonView,
    NewTuning,
    TuningListed,
    TuningSaved,
    TuningView,
)
from app.features.movement.tuning.service import (
    TUNINGS,
    follow_tuning,
    order_tuning,
    tuning_list,
    tuning_view,
)
from app.features.movement.tuning.tuning_queue import TuningQueue
from app.features.movement.tuning.worker_tasks import axis_curves, compared
from app.platform.dependencies import Context, Reading, SignedIn, Writing, write

router = APIRouter(prefix="/avatar-tunings", tags=["avatars"])


@router.get("")
def get_tunings(db: Reading, context: Context, _: SignedIn) -> list[TuningListed]:
    """Return the tunings, newest first, with the progress of those that are not ready."""
    return tuning_list(db, context)


@router.post("", status_code=201)
async def post_tuning(request: NewTuning, context: Context, caller: SignedIn) -> TuningView:
    """Start tuning an avatar; the response is immediate, and its view shows the progress."""
    tuning_id = await write(context, lambda db: order_tuning(db, context, caller, request))
    return await run_in_threadpool(follow_tuning, context, tuning_id)


@router.get("/{tuning_id}")
def get_tuning(tuning_id: str, db: Reading, context: Context, _: SignedIn) -> TuningView:
    """Return one tuning with every axis: what was measured so far, or the result."""
    return tuning_view(db, context, tuning_id)


@router.delete("/{tuning_id}", status_code=204)
async def delete_tuning(tuning_id: str, context: Context, caller: SignedIn) -> None:
    """Delete a tuning, or cancel it; versions that were saved of it stay."""
    await write(context, lambda db: TUNINGS.remove(db, context, caller, tuning_id))
    await run_in_threadpool(context.part(TuningQueue).forget, tuning_id)


@router.post("/{tuning_id}/stop")
async def stop_tuning(tuning_id: str, context: Context, caller: SignedIn) -> TuningView:
    """Stop a tuning; what it has measured is kept."""
    await write(context, lambda db: TUNINGS.stop(db, context, caller, tuning_id))
    return await run_in_threadpool(follow_tuning, context, tuning_id)


@router.post("/{tuning_id}/resume")
async def resume_tuning(tuning_id: str, context: Context, caller: SignedIn) -> TuningView:
    """Resume a stopped tuning, or retry a failed one; the result is as if it had not stopped."""
    await write(context, lambda db: TUNINGS.resume(db, context, caller, tuning_id))
    return await run_in_threadpool(follow_tuning, context, tuning_id)


@router.get("/{tuning_id}/axes/{axis}")
async def get_tuning_curves(
    tuning_id: str, axis: str, context: Context, _: SignedIn
) -> AxisCurvesView:
    """Return the curves of one axis: the relay experiment, and a step with old and new gains."""
    asked = await run_in_threadpool(asked_axis, context, tuning_id, axis)
    found = await context.part(TuningDesk).run_cached(
        axis_curves, asked.before, asked.after, axis, asked.relay_axis, asked.relay
    )
    return AxisCurvesView.model_validate({"axis": axis, **found})


@router.post("/{tuning_id}/configuration")
def post_tuning_configuration(
    tuning_id: str, request: AcceptedAxes, db: Reading, _: SignedIn
) -> AcceptedConfiguration:
    """Return the configuration with the new gains of the accepted axes; nothing is stored."""
    return accepted_configuration(db, tuning_id, request.accepted)


@router.post("/{tuning_id}/comparison")
async def post_tuning_comparison(
    tuning_id: str, request: ComparisonAsked, context: Context, _: SignedIn
) -> ComparisonView:
    """Compare how the body follows a capture with the old gains and with the accepted ones."""
    asked = await run_in_threadpool(
        asked_comparison, context, tuning_id, request.accepted, request.capture_id
    )
    found = await context.part(TuningDesk).run_cached(
        compared, asked.before, asked.after, asked.capture, request.longest_s
    )
    return ComparisonView.model_validate(found)


@router.post("/{tuning_id}/save", status_code=201)
def post_tuning_saved(
    tuning_id: str, request: TuningSaved, db: Writing, context: Context, caller: SignedIn
) -> AvatarView:
    """Save the accepted gains as an avatar's version, with the report of the tuning."""
    save_accepted(db, context, caller, tuning_id, request)
    return avatar_view(db, caller, request.key)
