"""Order, stop, resume and delete models of how people walk."""

from typing import Final, cast

from sqlalchemy.orm import Session

from app.errors import Conflict
from app.features.movement.files import drop_unused, size_of
from app.features.movement.jobs import JobKind
from app.features.movement.walking.fit_queue import FitQueue
from app.features.movement.walking.models.schemas import (
    FittedOn,
    ModelListed,
    ModelSummary,
    ModelView,
    ProgressView,
    SceneNamed,
)
from app.features.movement.walking.scenes import scene_text, scene_view
from app.features.movement.walking.schemas import FitChoice, Kind, NewModel, State
from app.features.movement.walking.set_sources import source_of_set
from app.features.movement.walking.sources import FitOrder
from app.features.movement.walking.walk_sets import walk_set_by_id, walk_set_view
from app.features.movement.walking.walked_with import (
    check_numbers,
    check_unchanged,
    walked_scenes,
)
from app.models import WalkingModelRow, new_id
from app.platform.access import Caller
from app.platform.context import AppContext

MODELS: Final = JobKind(
    table=WalkingModelRow,
    noun="model",
    running="fitting",
    action="walking.model",
    subject="walking_model",
    details=lambda row: {"kind": row.kind, "content": (row.content_hash or "")[:12]},
)


def ready_content(db: Session, model_id: str) -> tuple[str, str]:
    """Return the content hash and title of a fitted model; raise NotFound or NotNow."""
    row = MODELS.ready(db, model_id)
    return cast("str", row.content_hash), row.title


def model_list(db: Session, context: AppContext) -> list[ModelListed]:
    """Return all models, newest first."""
    return [_listed(row, context) for row in MODELS.newest_first(db)]


def model_view(db: Session, context: AppContext, model_id: str) -> ModelView:
    """Return one walking model in full; raise NotFound if there is none with this id."""
    row = MODELS.by_id(db, model_id)
    content_hash = row.content_hash
    return ModelView(
        **_listed(row, context).model_dump(),
        scene=None if row.scene is None else SceneNamed.model_validate(row.scene),
        options=FitChoice.model_validate(row.options),
        content_hash=content_hash,
        size_bytes=None if content_hash is None else size_of(db, content_hash),
        summary=None if row.summary is None else ModelSummary.model_validate(row.summary),
    )


def order_model(db: Session, context: AppContext, caller: Caller, request: NewModel) -> str:
    """Store the order of a model and return its id; `follow_fit` starts it after the commit.

    Raises NotFound, Conflict, or Busy if too many models are being fitted.
    """
    walks = walk_set_by_id(db, request.walk_set_id)
    view = walk_set_view(walks)
    check_numbers(view, request.options.depends_on)
    scene = None if request.scene is None else scene_view(db, request.scene)
    if scene is not None and walks.origin["kind"] == "population":
        raise Conflict(
            "synthetic walkers are planned in the scene that they were made for",
            value=scene.key,
            remedy="Leave the scene out, or generate another set of walks in it.",
        )
    row = WalkingModelRow(
        id=new_id(),
        title=request.title,
        kind=walks.kind,
        state="fitting",
        walk_set_id=walks.id,
        walk_set={
            "title": walks.title,
            "origin": walks.origin["kind"],
            "scenes": [one.model_dump(mode="json") for one in walked_scenes(db, view)],
        },
        scene=None
        if scene is None
        else {"key": scene.key, "title": scene.title, "content_hash": scene.content_hash},
        options=request.options.model_dump(mode="json"),
        by=caller.actor,
        at=context.clock.utc_now(),
    )
    MODELS.order(db, context, caller, row)
    return row.id


def order_of(db: Session, model_id: str) -> FitOrder:
    """Return a model's order for the worker process.

    Raises NotFound, or Conflict if a scene has changed since the order, or was deleted.
    """
    row = MODELS.by_id(db, model_id)
    if row.walk_set_id is None:
        raise Conflict("the walks of this model were deleted", value=row.walk_set["title"])
    scene = None
    if row.scene is not None:
        if scene_view(db, row.scene["key"]).content_hash != row.scene["content_hash"]:
            raise Conflict(
                "the scene has changed since the fit was ordered",
                value=row.scene["key"],
                remedy="Fit a new model.",
            )
        scene = scene_text(db, row.scene["key"])
    options = FitChoice.model_validate(row.options)
    check_unchanged(db, FittedOn(id=row.walk_set_id, **row.walk_set).scenes)
    return FitOrder(
        source=source_of_set(db, walk_set_view(walk_set_by_id(db, row.walk_set_id))),
        scene=scene,
        steps=options.steps,
        seed=options.seed,
        k=options.k,
        entries=options.entries,
        reading=options.reading,
        depends_on=tuple(options.depends_on),
    )


def follow_fit(context: AppContext, model_id: str) -> ModelView:
    """Start, keep or end the fit of a model as its committed state says, and return the model."""
    context.part(FitQueue).follow(model_id, order_of)
    with context.database.reading() as db:
        return model_view(db, context, model_id)


def resume_fit(db: Session, context: AppContext, caller: Caller, model_id: str) -> None:
    """Mark a stopped or failed fit as resumed; raise NotFound, NotNow, Conflict or Busy."""
    MODELS.resume(db, context, caller, model_id)
    order_of(db, model_id)


def remove_model(db: Session, context: AppContext, caller: Caller, model_id: str) -> None:
    """Delete a model, fitted or not; raise NotFound if there is none with this id."""

    def drop_file(row: WalkingModelRow) -> None:
        if row.content_hash is not None:
            drop_unused(db, row.content_hash)

    MODELS.remove(db, context, caller, model_id, drop_file)


def _listed(row: WalkingModelRow, context: AppContext) -> ModelListed:
    progress = None if row.state == "ready" else context.part(FitQueue).progress(row.id)
    return ModelListed(
        id=row.id,
        title=row.title,
        kind=cast("Kind", row.kind),
        state=cast("State", row.state),
        progress=None
        if progress is None
        else ProgressView.model_validate(progress, from_attributes=True),
        trouble=row.trouble,
        walk_set=FittedOn(id=row.walk_set_id, **row.walk_set),
        walks=None if row.summary is None else row.summary["walks"],
        people=None if row.summary is None else row.summary["people"],
        by=row.by,
        at=row.at,
        ended_at=row.ended_at,
    )
