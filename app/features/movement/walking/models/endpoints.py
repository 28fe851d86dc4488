"""HTTP endpoints of models of walking and their predictions."""

from itertools import pairwise
from math import dist

from fastapi import APIRouter
from fastapi.responses import StreamingResponse
from starlette.concurrency import run_in_threadpool

from app.features.movement.files import BYTES, attachment, binary, sent
from app.features.movement.walking.fit_queue import FitQueue
from app.features.movement.walking.models.schemas import (
    ModelListed,
    ModelView,
    PathAsked,
    PathView,
    PredictionAsked,
    PredictionView,
    SliceAsked,
    SliceView,
)
from app.features.movement.walking.prediction_queue import PredictionQueue
from app.features.movement.walking.scenes import scene_text
from app.features.movement.walking.schemas import NewModel
from app.features.movement.walking.service import (
    MODELS,
    follow_fit,
    model_list,
    model_view,
    order_model,
    ready_content,
    remove_model,
    resume_fit,
)
from app.features.movement.walking.sources import Question, SliceQuestion
from app.features.movement.walking.walk_sets import store_of
from app.features.movement.walking.worker_tasks import plan_path, predict_walk, slice_of
from app.platform.context import AppContext
from app.platform.dependencies import Context, Reading, SignedIn, write

router = APIRouter(prefix="/walking", tags=["walking"])


@router.get("/models")
def get_models(db: Reading, context: Context, _: SignedIn) -> list[ModelListed]:
    """Return the models, newest first, with the progress of those that are being fitted."""
    return model_list(db, context)


@router.post("/models", status_code=201)
async def post_model(request: NewModel, context: Context, caller: SignedIn) -> ModelView:
    """Start fitting a model; the response is immediate, and the model's view shows the progress."""
    model_id = await write(context, lambda db: order_model(db, context, caller, request))
    return await run_in_threadpool(follow_fit, context, model_id)


@router.get("/models/{model_id}")
def get_model(model_id: str, db: Reading, context: Context, _: SignedIn) -> ModelView:
    """Return one model: its walks and options, and its errors on data that were left out."""
    return model_view(db, context, model_id)


@router.delete("/models/{model_id}", status_code=204)
async def delete_model(model_id: str, context: Context, caller: SignedIn) -> None:
    """Delete a model, or cancel its fit."""
    await write(context, lambda db: remove_model(db, context, caller, model_id))
    await run_in_threadpool(context.part(FitQueue).forget, model_id)


@router.post("/models/{model_id}/stop")
async def stop_model(model_id: str, context: Context, caller: SignedIn) -> ModelView:
    """Stop fitting a model; its finished maps are kept."""
    await write(context, lambda db: MODELS.stop(db, context, caller, model_id))
    return await run_in_threadpool(follow_fit, context, model_id)


@router.post("/models/{model_id}/resume")
async def resume_model(model_id: str, context: Context, caller: SignedIn) -> ModelView:
    """Resume a stopped fit, or retry a failed one."""
    await write(context, lambda db: resume_fit(db, context, caller, model_id))
    return await run_in_threadpool(follow_fit, context, model_id)


@router.get(
    "/models/{model_id}/file",
    response_class=StreamingResponse,
    responses={200: binary("The model's file, as `./run walk` reads it.")},
)
def get_model_file(model_id: str, context: Context, _: SignedIn) -> StreamingResponse:
    """Download the model as a file."""
    with context.database.reading() as db:
        content_hash, _title = ready_content(db, model_id)
        summary = model_view(db, context, model_id).summary
    # The hash that the page shows and the file itself contains.
    shown = content_hash if summary is None else summary.model_hash
    headers = attachment(f"walking-{shown[:12]}.npz")
    return StreamingResponse(sent(context, content_hash), media_type=BYTES, headers=headers)


@router.post("/paths")
async def post_path(request: PathAsked, context: Context, _: SignedIn) -> PathView:
    """Return the shortest path between two points, or check that a drawn one avoids obstacles."""
    question = await run_in_threadpool(_question, context, request)
    points = await context.part(PredictionQueue).run_cached(plan_path, question)
    length_m = sum(dist(a, b) for a, b in pairwise(points))
    return PathView(points_m=points, length_m=length_m)


@router.post("/models/{model_id}/prediction")
async def post_prediction(
    model_id: str, request: PredictionAsked, context: Context, _: SignedIn
) -> PredictionView:
    """Predict how long people take on a path: a distribution, and walks drawn from it."""
    content_hash = await run_in_threadpool(_content, context, model_id)
    question = await run_in_threadpool(_question, context, request)
    found = await context.part(PredictionQueue).run_cached(
        predict_walk, store_of(context), content_hash, question
    )
    return PredictionView.model_validate(found)


@router.post("/models/{model_id}/slice")
async def post_slice(
    model_id: str, request: SliceAsked, context: Context, _: SignedIn
) -> SliceView:
    """Return how suitable steering parameters are for a walk: a slice of the map."""
    content_hash = await run_in_threadpool(_content, context, model_id)
    question = SliceQuestion(
        tuple(sorted(request.dependencies.items())), request.held, request.value
    )
    found = await context.part(PredictionQueue).run_cached(
        slice_of, store_of(context), content_hash, question
    )
    return SliceView.model_validate(found)


def _content(context: AppContext, model_id: str) -> str:
    with context.database.reading() as db:
        return ready_content(db, model_id)[0]


def _question(context: AppContext, request: PathAsked) -> Question:
    with context.database.reading() as db:
        scene = None if request.scene is None else scene_text(db, request.scene)
    points = tuple((float(x), float(y)) for x, y in request.points_m)
    if not isinstance(request, PredictionAsked):
        return Question(scene, points, request.planned, None, 1, 0, 0)
    others = tuple(sorted(request.others.items()))
    drawn = (request.stature_m, request.count, request.seed, request.shown, others)
    return Question(scene, points, request.planned, *drawn)
