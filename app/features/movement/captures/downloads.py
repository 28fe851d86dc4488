"""What leaves as a file: as it was uploaded, or as it moves on an avatar."""

import os
import tempfile
from collections.abc import AsyncIterator, Generator
from pathlib import Path
from urllib.parse import quote

from starlette.concurrency import iterate_in_threadpool, run_in_threadpool

from app.errors import NotFound
from app.features.movement.captures.avatars import Mapped
from app.features.movement.captures.contents import plain_pieces
from app.features.movement.captures.schemas import ExportFormat
from app.features.movement.captures.service import capture_by_id
from app.features.movement.captures.tasks import write_retargeted
from app.features.movement.captures.workbench import Workbench
from app.platform.context import AppContext


def stored_file(context: AppContext, capture_id: str, *, companion: bool) -> tuple[str, str]:
    """Name and content hash of a capture's file; raises NotFound."""
    with context.database.reading() as db:
        row = capture_by_id(db, capture_id)
    if not companion:
        return row.file_name, row.content_hash
    if row.companion_name is None or row.companion_hash is None:
        raise NotFound("this capture has no companion file", value=row.file_name)
    return row.companion_name, row.companion_hash


async def sent(context: AppContext, content_hash: str) -> AsyncIterator[bytes]:
    """The content, piece by piece as the reader takes it."""
    pieces = _pieces(context, content_hash)
    try:
        async for piece in iterate_in_threadpool(pieces):
            yield piece
    finally:
        # Also when the reader has gone away: the look at the database must end.
        await run_in_threadpool(pieces.close)


async def retargeted_file(
    context: AppContext, mapped: Mapped, avatar: str, format_: ExportFormat, *, lock_feet: bool
) -> Path:
    """A file of the movement on an avatar, which the caller removes; raises InvalidInput."""
    path = await run_in_threadpool(_new_file)
    try:
        await context.part(Workbench).run(
            write_retargeted, mapped, avatar, format_, path, lock_feet=lock_feet
        )
    except BaseException:
        await run_in_threadpool(path.unlink)
        raise
    return path


def attachment(name: str) -> dict[str, str]:
    """The header that makes a browser keep an answer as a file of this name."""
    return {"content-disposition": f"attachment; filename*=UTF-8''{quote(name, safe='')}"}


def _new_file() -> Path:
    handle, name = tempfile.mkstemp(prefix="reembody-retargeted-")
    os.close(handle)
    return Path(name)


def _pieces(context: AppContext, content_hash: str) -> Generator[bytes, None, None]:
    with context.database.reading() as db:
        yield from plain_pieces(db, content_hash)
