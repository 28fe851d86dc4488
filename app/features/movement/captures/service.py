"""Add, change and delete the captures of the lab."""

from collections.abc import AsyncIterator
from dataclasses import dataclass
from typing import Any

from anyio.to_thread import run_sync
from sqlalchemy import select
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotFound
from app.features.movement.captures.capture_queue import CaptureQueue
from app.features.movement.captures.inspecting import (
    Inspected,
    inspect_stored,
    inspect_upload,
)
from app.features.movement.captures.opening import Store
from app.features.movement.captures.schemas import CaptureChange, ReadingChoice
from app.features.movement.captures.source import Source, source_of
from app.features.movement.files import Uploaded, compressed_beside, drop_unused, store, uploaded
from app.features.people.audit import record
from app.models import CaptureRow, new_id
from app.platform.access import Caller
from app.platform.context import AppContext


@dataclass(frozen=True)
class UploadOptions:
    """The parameters of an upload: names of its files, and conventions to parse them with."""

    name: str
    companion: str | None
    companion_bytes: int | None
    reading: ReadingChoice


def capture_by_id(db: Session, capture_id: str, *, lock: bool = False) -> CaptureRow:
    """Return the capture with this id; raise NotFound if there is none."""
    row = db.get(CaptureRow, capture_id, with_for_update=lock)
    if row is None:
        raise NotFound("there is no such capture", value=capture_id)
    return row


def store_of(context: AppContext) -> Store:
    """Return the store from which the worker process reads contents."""
    settings = context.settings
    return Store(settings.resolved_database_url, settings.max_capture_bytes)


def source_of_capture(
    context: AppContext, capture_id: str, reading: ReadingChoice | None = None
) -> Source:
    """Return the source of a stored capture, for the worker process; raise NotFound."""
    with context.database.reading() as db:
        return source_of(capture_by_id(db, capture_id), reading)


async def add_capture(
    context: AppContext, caller: Caller, request: UploadOptions, body: AsyncIterator[bytes]
) -> tuple[str, bool]:
    """Parse and store an upload; return the capture's id, and whether it is new.

    Raises InvalidInput if it cannot be parsed; nothing is stored then.
    """
    if (request.companion is None) != (request.companion_bytes is None):
        raise InvalidInput(
            "a companion needs its name and its size",
            value=request.companion or request.companion_bytes,
            valid="both of companion and companion_bytes, or neither",
        )
    async with uploaded(context, body, request.companion_bytes) as files:
        source = _source(request, files)
        existing_id = await run_sync(_id_of, context, source.identity)
        if existing_id is not None:
            return existing_id, False
        paths = tuple(file.path for file in files)
        max_bytes = context.settings.max_capture_bytes
        inspected = await context.part(CaptureQueue).run(inspect_upload, max_bytes, source, paths)
        async with context.database.writing_async() as db:
            return await run_sync(_store, db, context, caller, request, source, files, inspected)


async def change_capture(
    context: AppContext, caller: Caller, capture_id: str, request: CaptureChange
) -> None:
    """Change the title or the conventions; raise NotFound or InvalidInput."""
    inspected: Inspected | None = None
    if request.reading is not None:
        source = await run_sync(source_of_capture, context, capture_id, request.reading)
        inspected = await context.part(CaptureQueue).run(inspect_stored, store_of(context), source)
    async with context.database.writing_async() as db:
        await run_sync(_change, db, context, caller, capture_id, request, inspected)


def remove_capture(db: Session, context: AppContext, caller: Caller, capture_id: str) -> None:
    """Delete a capture, and its contents if they are not used elsewhere; raise NotFound."""
    row = capture_by_id(db, capture_id, lock=True)
    hashes = [one for one in (row.content_hash, row.companion_hash) if one is not None]
    db.delete(row)
    db.flush()
    for content_hash in sorted(set(hashes)):
        drop_unused(db, content_hash)
    _record(db, context, caller, row, action="capture.removed")


def _source(request: UploadOptions, files: tuple[Uploaded, ...]) -> Source:
    return Source(
        name=request.name,
        hash=files[0].hash,
        companion_name=request.companion,
        companion_hash=files[1].hash if len(files) > 1 else None,
        metres_per_unit=request.reading.metres_per_unit,
        up=request.reading.up,
    )


def _id_of(context: AppContext, identity: str) -> str | None:
    with context.database.reading() as db:
        return db.scalar(select(CaptureRow.id).where(CaptureRow.identity == identity))


def _store(
    db: Session,
    context: AppContext,
    caller: Caller,
    request: UploadOptions,
    source: Source,
    files: tuple[Uploaded, ...],
    inspected: Inspected,
) -> tuple[str, bool]:
    for file in sorted(files, key=lambda one: one.hash):
        store(db, file.hash, file.size, compressed_beside(file.path))
    values = {
        "id": new_id(),
        "identity": source.identity,
        "title": request.name,
        "file_name": request.name,
        "content_hash": source.hash,
        "companion_name": source.companion_name,
        "companion_hash": source.companion_hash,
        "reading": request.reading.model_dump(),
        "by": caller.actor,
        "at": context.clock.utc_now(),
        **_columns(inspected),
    }
    insert = (postgresql if db.get_bind().dialect.name == "postgresql" else sqlite).insert
    new = insert(CaptureRow).values(values).on_conflict_do_nothing().returning(CaptureRow.id)
    inserted_id = db.execute(new).scalar()
    row = db.scalars(select(CaptureRow).where(CaptureRow.identity == source.identity)).one()
    if inserted_id is not None:
        _record(db, context, caller, row, action="capture.added")
    return row.id, inserted_id is not None


def _change(
    db: Session,
    context: AppContext,
    caller: Caller,
    capture_id: str,
    request: CaptureChange,
    inspected: Inspected | None,
) -> None:
    row = capture_by_id(db, capture_id, lock=True)
    if request.title is not None:
        row.title = request.title
    if request.reading is not None and inspected is not None:
        row.reading = request.reading.model_dump()
        for name, value in _columns(inspected).items():
            setattr(row, name, value)
    db.flush()
    _record(db, context, caller, row, action="capture.changed", reading=inspected is not None)


def _columns(inspected: Inspected) -> dict[str, Any]:
    return {
        "format": inspected.format,
        "kind": inspected.kind,
        "frames": inspected.frames,
        "rate_hz": inspected.rate_hz,
        "duration_s": inspected.duration_s,
        "tracks": inspected.tracks,
        "fingerprint": inspected.fingerprint,
        "summary": inspected.summary.model_dump(mode="json"),
    }


def _record(
    db: Session,
    context: AppContext,
    caller: Caller,
    row: CaptureRow,
    *,
    action: str,
    **more: object,
) -> None:
    # The id, not the file's name, which may be a person's: the audit trail cannot be erased.
    record(
        db,
        actor=caller.actor,
        action=action,
        subject=f"capture:{row.id}",
        details={"format": row.format, "content": row.content_hash[:12], **more},
        now=context.clock.utc_now(),
    )


def stored_file(context: AppContext, capture_id: str, *, companion: bool) -> tuple[str, str]:
    """Return the name and content hash of a capture's file; raise NotFound if there is none."""
    with context.database.reading() as db:
        row = capture_by_id(db, capture_id)
    if not companion:
        return row.file_name, row.content_hash
    if row.companion_name is None or row.companion_hash is None:
        raise NotFound("this capture has no companion file", value=row.file_name)
    return row.companion_name, row.companion_hash
