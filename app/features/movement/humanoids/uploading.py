"""Parse humanoid models in the worker process for captures: uploaded ones and stored ones."""

from collections.abc import AsyncIterator
from dataclasses import asdict

from anyio.to_thread import run_sync
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.errors import InvalidInput
from app.features.movement.captures import CaptureQueue
from app.features.movement.files import Uploaded, compressed_beside, sent, store, uploaded
from app.features.movement.humanoids.service import humanoid_by_hash, is_known
from app.features.movement.humanoids.worker_tasks import Measured, Refused, binding_json, measure
from app.features.people.audit import record
from app.models import HumanoidRow
from app.platform.access import Caller
from app.platform.context import AppContext

WITHIN_S = 60.0
"""Time limit of reading a model; one of 32,000 vertices takes about a second."""
_REMEDY = (
    "Open the model in the program that made it, such as Blender or VRoid Studio, correct this, "
    "and export it as one file: glTF binary (.glb) or VRM. Help, “The configuration of an avatar”, "
    "lists what is read."
)


async def add_humanoid(
    context: AppContext, caller: Caller, name: str, body: AsyncIterator[bytes]
) -> tuple[str, bool]:
    """Parse and store an upload; return its content hash, and whether it is new.

    Raises InvalidInput if it is not a humanoid model; nothing is stored then.
    """
    async with uploaded(context, body, None) as files:
        file = files[0]
        if await run_sync(_is_known, context, file.hash):
            return file.hash, False
        measured = await _measured(context, name, file)
        async with context.database.writing_async() as db:
            new = await run_sync(_store, db, context, caller, name, file, measured)
            return file.hash, new


async def stored_binding(context: AppContext, content_hash: str) -> bytes:
    """Return the binding of a stored model as JSON; raise NotFound if there is no such model."""
    await run_sync(_require, context, content_hash)
    settings = context.settings
    url, max_bytes = settings.resolved_database_url, settings.max_capture_bytes
    return await context.part(CaptureQueue).run_cached(binding_json, url, max_bytes, content_hash)


async def measure_again(context: AppContext, caller: Caller, content_hash: str) -> None:
    """Read the licence and counts of a body from its stored file again, and store them.

    Its figure stays as it is: avatars that were built from it do not change. Raises NotFound, and
    InvalidInput if this release cannot read the file any more.
    """
    name = await run_sync(_file_name, context, content_hash)
    async with uploaded(context, sent(context, content_hash), None) as files:
        measured = await _measured(context, name, files[0])
    async with context.database.writing_async() as db:
        await run_sync(_store_counts, db, context, caller, content_hash, measured)


def _file_name(context: AppContext, content_hash: str) -> str:
    with context.database.reading() as db:
        return humanoid_by_hash(db, content_hash).file_name


def _store_counts(
    db: Session, context: AppContext, caller: Caller, content_hash: str, measured: Measured
) -> None:
    row = humanoid_by_hash(db, content_hash, lock=True)
    row.licence, row.triangles = measured.licence, measured.triangles
    row.vertices, row.textures = measured.vertices, measured.textures
    record(
        db,
        actor=caller.actor,
        action="humanoid.measured",
        subject=f"humanoid:{content_hash[:12]}",
        details={"content": content_hash[:12]},
        now=context.clock.utc_now(),
    )


async def _measured(context: AppContext, name: str, file: Uploaded) -> Measured:
    try:
        max_bytes = context.settings.max_capture_bytes
        found = await context.part(CaptureQueue).run_within(WITHIN_S, measure, max_bytes, file.path)
    except InvalidInput as error:
        # A limit was exceeded; the message for captures does not apply to models.
        raise InvalidInput(
            "the model cannot be read: it takes too much time or memory",
            value=name,
            remedy="Export it with fewer vertices and bones.",
        ) from error
    if isinstance(found, Refused):
        place = f"{found.place}: " if found.place else ""
        raise InvalidInput(
            f"{place}{found.reason}",
            value=name,
            remedy=_REMEDY,
            details=[{"path": found.place, "message": found.reason}],
        )
    return found


def _require(context: AppContext, content_hash: str) -> None:
    with context.database.reading() as db:
        humanoid_by_hash(db, content_hash)


def _is_known(context: AppContext, content_hash: str) -> bool:
    with context.database.reading() as db:
        return is_known(db, content_hash)


def _store(
    db: Session,
    context: AppContext,
    caller: Caller,
    name: str,
    file: Uploaded,
    measured: Measured,
) -> bool:
    store(db, file.hash, file.size, compressed_beside(file.path))
    now = context.clock.utc_now()
    insert = (postgresql if db.get_bind().dialect.name == "postgresql" else sqlite).insert
    new = insert(HumanoidRow).values(
        hash=file.hash,
        file_name=name,
        **asdict(measured),
        by=caller.actor,
        at=now,
    )
    if db.execute(new.on_conflict_do_nothing().returning(HumanoidRow.hash)).first() is None:
        return False
    record(
        db,
        actor=caller.actor,
        action="humanoid.added",
        subject=f"humanoid:{file.hash[:12]}",
        details={"content": file.hash[:12]},
        now=now,
    )
    return True
