"""Sets of walks: from uploaded tables, from captures, or synthetic."""

import hashlib
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory

from anyio.to_thread import run_sync
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Conflict, NotFound
from app.features.movement.files import compress, drop_unused, store, uploaded
from app.features.movement.walking.prediction_queue import PredictionQueue
from app.features.movement.walking.schemas import (
    CapturesOrigin,
    Kind,
    NewWalkSet,
    PopulationOrigin,
    TracksOrigin,
    WalkSetView,
    WalksSummary,
)
from app.features.movement.walking.set_sources import (
    all_scenes,
    captured_walks,
    captures_source,
    population_source,
    tracks_source,
)
from app.features.movement.walking.sources import Store
from app.features.movement.walking.worker_tasks import (
    captured_table,
    inspected_population,
    inspected_tracks,
)
from app.features.people.audit import record
from app.models import WalkingModelRow, WalkSetRow
from app.platform.access import Caller
from app.platform.context import AppContext
from app.platform.incomplete_files import uploads_of


@dataclass(frozen=True)
class Table:
    """The parameters of an uploaded table of tracks."""

    title: str
    kind: Kind
    origin: TracksOrigin


def store_of(context: AppContext) -> Store:
    """Return the store from which worker processes read contents."""
    return Store(context.settings.resolved_database_url)


def walk_set_by_id(db: Session, set_id: str, *, lock: bool = False) -> WalkSetRow:
    """Return the set with this id; raise NotFound if there is none."""
    row = db.get(WalkSetRow, set_id, with_for_update=lock)
    if row is None:
        raise NotFound("there is no such set of walks", value=set_id)
    return row


def walk_set_view(row: WalkSetRow) -> WalkSetView:
    """Return a set as a response model."""
    return WalkSetView.model_validate(row, from_attributes=True)


def walk_set_list(db: Session) -> list[WalkSetView]:
    """Return all sets, newest first."""
    rows = db.scalars(select(WalkSetRow).order_by(WalkSetRow.at.desc(), WalkSetRow.id))
    return [walk_set_view(row) for row in rows]


async def add_table(
    context: AppContext, caller: Caller, request: Table, body: AsyncIterator[bytes]
) -> WalkSetView:
    """Store a table of tracks; raise InvalidInput with the line that cannot be parsed."""
    async with uploaded(context, body, None) as (file,):
        scenes = await run_sync(all_scenes, context)
        source = tracks_source(request.origin, request.kind, file.hash, scenes)
        found = await context.part(PredictionQueue).run(inspected_tracks, source, file.path)
        row = _row(context, caller, request.title, request.kind, request.origin, file.hash)
        row.summary = WalksSummary.model_validate(found).model_dump(mode="json")
        return await _stored(context, caller, row, _storing(file.hash, file.path))


async def add_walk_set(context: AppContext, caller: Caller, request: NewWalkSet) -> WalkSetView:
    """Synthesise walks, or cut them from captures; raise InvalidInput or NotFound."""
    if isinstance(request.origin, CapturesOrigin):
        return await _add_captured(context, caller, request.title, request.origin)
    source = await run_sync(population_source, context, request.origin)
    found = await context.part(PredictionQueue).run(inspected_population, source)
    row = _row(context, caller, request.title, "synthetic", request.origin, None)
    row.summary = WalksSummary.model_validate(found).model_dump(mode="json")
    return await _stored(context, caller, row, lambda _: None)


def remove_walk_set(db: Session, context: AppContext, caller: Caller, set_id: str) -> None:
    """Delete a set; models that were fitted to it stay. Raises NotFound, Conflict."""
    row = walk_set_by_id(db, set_id, lock=True)
    users = list(db.scalars(select(WalkingModelRow).where(WalkingModelRow.walk_set_id == set_id)))
    unfinished = [model.title for model in users if model.state != "ready"]
    if unfinished:
        raise Conflict(
            "a model that is not finished needs these walks",
            value=unfinished,
            remedy="Let it finish, or delete it first.",
        )
    for model in users:
        model.walk_set_id = None
    db.flush()
    db.delete(row)
    db.flush()
    if row.content_hash is not None:
        drop_unused(db, row.content_hash)
    _record(db, context, caller, row, "walking.walks_removed")


async def _add_captured(
    context: AppContext, caller: Caller, title: str, origin: CapturesOrigin
) -> WalkSetView:
    scenes = await run_sync(all_scenes, context)
    source = captures_source(origin, "", scenes)
    captures = await run_sync(captured_walks, context, origin)
    found = await context.part(PredictionQueue).run(
        captured_table, store_of(context), captures, source
    )
    content_hash = hashlib.sha256(found.table).hexdigest()
    row = _row(context, caller, title, "human", origin, content_hash)
    row.summary = WalksSummary.model_validate(found.summary).model_dump(mode="json")
    with TemporaryDirectory(dir=uploads_of(context.settings)) as folder:
        file = Path(folder) / "tracks.csv"
        await run_sync(file.write_bytes, found.table)
        return await _stored(context, caller, row, _storing(content_hash, file))


def _storing(content_hash: str, file: Path) -> Callable[[Session], None]:
    compressed = file.with_name("compressed")
    compress(file, compressed)
    size = file.stat().st_size
    return lambda db: store(db, content_hash, size, compressed)


def _row(
    context: AppContext,
    caller: Caller,
    title: str,
    kind: Kind,
    origin: PopulationOrigin | CapturesOrigin | TracksOrigin,
    content_hash: str | None,
) -> WalkSetRow:
    return WalkSetRow(
        title=title,
        kind=kind,
        origin=origin.model_dump(mode="json"),
        content_hash=content_hash,
        by=caller.actor,
        at=context.clock.utc_now(),
    )


async def _stored(
    context: AppContext, caller: Caller, row: WalkSetRow, storing: Callable[[Session], None]
) -> WalkSetView:
    def keep(db: Session) -> WalkSetView:
        storing(db)
        db.add(row)
        db.flush()
        _record(db, context, caller, row, "walking.walks_added")
        return walk_set_view(row)

    async with context.database.writing_async() as db:
        return await run_sync(keep, db)


def _record(db: Session, context: AppContext, caller: Caller, row: WalkSetRow, act: str) -> None:
    record(
        db,
        actor=caller.actor,
        action=act,
        subject=f"walk_set:{row.id}",
        details={"kind": row.kind, "origin": row.origin["kind"], "walks": row.summary["walks"]},
        now=context.clock.utc_now(),
    )
