"""Receive uploads onto the disk while hashing them, and send downloads in pieces.

Neither is ever completely in memory.
"""

import hashlib
import tempfile
from collections.abc import AsyncIterator, Generator
from contextlib import asynccontextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, BinaryIO
from urllib.parse import quote

from anyio.to_thread import run_sync
from pydantic import StringConstraints
from starlette.concurrency import iterate_in_threadpool, run_in_threadpool
from starlette.requests import ClientDisconnect

from app.errors import InvalidInput, NotDurable
from app.features.movement.files.contents import plain_pieces
from app.platform.context import AppContext
from app.platform.incomplete_files import uploads_of
from app.platform.trouble import not_durable_error

BLOCK_BYTES = 1024 * 1024
FileName = Annotated[
    str,
    StringConstraints(
        min_length=1,
        max_length=200,
        # No control characters, none that turn the direction of writing around, no folders.
        pattern=r"^[^\x00-\x1f\x7f\u200e\u200f\u202a-\u202e\u2066-\u2069/\\]+$",
    ),
]
BYTES = "application/octet-stream"
BINARY: dict[str, Any] = {"schema": {"type": "string", "format": "binary"}}
BODY: dict[str, Any] = {"requestBody": {"required": True, "content": {BYTES: BINARY}}}
"""The OpenAPI description of a request whose body is a file."""


@dataclass(frozen=True)
class Uploaded:
    """An uploaded file on disk, with its SHA-256 and its size in bytes."""

    path: Path
    hash: str
    size: int


@asynccontextmanager
async def uploaded(
    context: AppContext, body: AsyncIterator[bytes], companion_bytes: int | None
) -> AsyncIterator[tuple[Uploaded, ...]]:
    """Yield the files of a request's body, in a temporary folder of the data folder.

    The last `companion_bytes` are a file of their own. Raises InvalidInput if a file is empty or
    the connection breaks off, NotDurable if there is no space for it.
    """
    folder = await run_sync(_new_folder, context)
    try:
        whole = Path(folder.name) / "capture"
        size = await _received_whole(body, whole)
        if size <= (companion_bytes or 0):
            raise InvalidInput(
                "the file is empty" if companion_bytes is None else "the first file is empty",
                value=size,
                valid="a file with a recording or a model in it",
                remedy="Choose another file, or export this one again.",
            )
        yield await run_sync(_split, whole, size, companion_bytes)
    finally:
        await run_sync(folder.cleanup)


def _new_folder(context: AppContext) -> "tempfile.TemporaryDirectory[str]":
    try:
        return tempfile.TemporaryDirectory(
            dir=uploads_of(context.settings), ignore_cleanup_errors=True
        )
    except OSError as error:
        raise not_durable_error("the upload could not be stored", error) from error


async def _received_whole(body: AsyncIterator[bytes], to: Path) -> int:
    try:
        return await _received(body, to)
    except ClientDisconnect as error:
        raise InvalidInput("the upload was interrupted", remedy="Send the file again.") from error
    except OSError as error:
        raise NotDurable(
            f"the upload could not be stored: {error.strerror}",
            remedy="Free some space in the data folder of the server, then try again.",
        ) from error


async def _received(body: AsyncIterator[bytes], to: Path) -> int:
    size, block = 0, bytearray()
    file: BinaryIO = await run_sync(to.open, "wb")
    try:
        async for piece in body:
            size += len(piece)
            block += piece
            if len(block) >= BLOCK_BYTES:
                await run_sync(file.write, bytes(block))
                block.clear()
        await run_sync(file.write, bytes(block))
    finally:
        await run_sync(file.close)
    return size


def _split(whole: Path, size: int, companion_bytes: int | None) -> tuple[Uploaded, ...]:
    if companion_bytes is None:
        return (_measured(whole),)
    companion_path = whole.with_name("companion")
    with whole.open("r+b") as file, companion_path.open("wb") as companion:
        file.seek(size - companion_bytes)
        while block := file.read(BLOCK_BYTES):
            companion.write(block)
        file.truncate(size - companion_bytes)
    return (_measured(whole), _measured(companion_path))


def _measured(path: Path) -> Uploaded:
    with path.open("rb") as file:
        digest: Any = hashlib.file_digest(file, "sha256")
    return Uploaded(path, digest.hexdigest(), path.stat().st_size)


def binary(description: str) -> dict[str, Any]:
    """Return the OpenAPI description of a response of bytes."""
    return {"content": {BYTES: BINARY}, "description": description}


def attachment(name: str) -> dict[str, str]:
    """Return the header that makes a browser save a response as a file of this name."""
    return {"content-disposition": f"attachment; filename*=UTF-8''{quote(name, safe='')}"}


def sent(context: AppContext, content_hash: str) -> AsyncIterator[bytes]:
    """Return the pieces of a stored content, read from the database as they are sent."""
    return streamed(_pieces(context, content_hash))


async def streamed(pieces: Generator[bytes, None, None]) -> AsyncIterator[bytes]:
    """Yield the pieces as they are sent, each made in a thread."""
    try:
        async for piece in iterate_in_threadpool(pieces):
            yield piece
    finally:
        # The database transaction must end even if the client has disconnected.
        await run_in_threadpool(pieces.close)


def _pieces(context: AppContext, content_hash: str) -> Generator[bytes, None, None]:
    with context.database.reading() as db:
        yield from plain_pieces(db, content_hash)
