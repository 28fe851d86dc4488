"""Order, stop, resume and delete models of how people walk."""

from typing import cast

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Conflict, NotFound, NotNow
from app.features.movement.files import drop_unused, size_of
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
from app.features.people.audit import record
from app.models import WalkingModelRow, new_id
from app.platform.access import Caller
from app.platform.context import AppContext


def model_by_id(db: Session, model_id: str, *, lock: bool = False) -> WalkingModelRow:
    """Return the model with this id; raise NotFound if there is none."""
    row = db.get(WalkingModelRow, model_id, with_for_update=lock)
    if row is None:
        raise NotFound("there is no such model", value=model_id)
    return row


def ready_content(db: Session, model_id: str) -> tuple[str, str]:
    """Return the content hash and title of a fitted model; raise NotFound or NotNow."""
    row = model_by_id(db, model_id)
    if row.state != "ready" or row.content_hash is None:
        raise NotNow(
            "this model is not fitted yet",
            value=row.state,
            valid="ready",
            remedy="Wait until it is, or resume it.",
        )
    return row.content_hash, row.title


def model_list(db: Session, context: AppContext) -> list[ModelListed]:
    """Return all models, newest first."""
    rows = db.scalars(
        select(WalkingModelRow).order_by(WalkingModelRow.at.desc(), WalkingModelRow.id)
    )
    return [_listed(row, context) for row in rows]


def model_view(db: Session, context: AppContext, model_id: str) -> ModelView:
    """Return one walking model in full; raise NotFound if there is none with this id."""
    row = model_by_id(db, model_id)
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
    """Store the order of a model and return its id; `begin_fit` starts it after the commit."""
    walks = walk_set_by_id(db, request.walk_set_id)
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
        walk_set={"title": walks.title, "origin": walks.origin["kind"]},
        scene=None
        if scene is None
        else {"key": scene.key, "title": scene.title, "content_hash": scene.content_hash},
        options=request.options.model_dump(mode="json"),
        by=caller.actor,
        at=context.clock.utc_now(),
    )
    db.add(row)
    db.flush()
    _record(db, context, caller, row, "walking.model_ordered")
    return row.id


def order_of(db: Session, model_id: str) -> FitOrder:
    """Return a model's order for the worker process.

    Raises NotFound, or Conflict if the scene has changed since the order.
    """
    row = model_by_id(db, model_id)
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
    return FitOrder(
        source=source_of_set(db, walk_set_view(walk_set_by_id(db, row.walk_set_id))),
        scene=scene,
        steps=options.steps,
        seed=options.seed,
        k=options.k,
        entries=options.entries,
        reading=options.reading,
    )


def begin_fit(context: AppContext, model_id: str) -> ModelView:
    """Start the fit of a stored order."""
    with context.database.reading() as db:
        order = order_of(db, model_id)
        context.part(FitQueue).order(model_id, order)
        return model_view(db, context, model_id)


def mark_stopped(db: Session, context: AppContext, caller: Caller, model_id: str) -> None:
    """Mark a fit as stopped; raise NotFound, or NotNow if it is not being fitted."""
    row = _in_state(db, model_id, "fitting")
    row.state = "stopped"
    db.flush()
    _record(db, context, caller, row, "walking.model_stopped")


def mark_resumed(db: Session, context: AppContext, caller: Caller, model_id: str) -> None:
    """Mark a stopped or failed fit as resumed; raise NotFound, NotNow or Conflict."""
    row = _in_state(db, model_id, "stopped", "failed")
    order_of(db, model_id)
    row.state, row.trouble = "fitting", None
    db.flush()
    _record(db, context, caller, row, "walking.model_resumed")


def remove_model(db: Session, context: AppContext, caller: Caller, model_id: str) -> None:
    """Delete a model, fitted or not; raise NotFound if there is none with this id."""
    row = model_by_id(db, model_id, lock=True)
    db.delete(row)
    db.flush()
    if row.content_hash is not None:
        drop_unused(db, row.content_hash)
    _record(db, context, caller, row, "walking.model_removed")


def _in_state(db: Session, model_id: str, *states: State) -> WalkingModelRow:
    row = model_by_id(db, model_id, lock=True)
    if row.state not in states:
        raise NotNow(
            f"the model is {row.state}",
            value=row.state,
            valid=list(states),
            remedy="Reload the page: somebody else has changed its state, or it has ended.",
        )
    return row


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


def _record(
    db: Session, context: AppContext, caller: Caller, row: WalkingModelRow, action: str
) -> None:
    # The id, not the title, which may contain a person's name: the audit trail cannot be erased.
    record(
        db,
        actor=caller.actor,
        action=action,
        subject=f"walking_model:{row.id}",
        details={"kind": row.kind, "content": (row.content_hash or "")[:12]},
        now=context.clock.utc_now(),
    )
