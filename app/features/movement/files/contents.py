"""Store files in the database: compressed, in pieces, and once per content hash."""

from collections.abc import Iterable, Iterator
from io import BytesIO
from pathlib import Path
from typing import BinaryIO

import zstandard
from sqlalchemy import delete, make_url, or_, select
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

from app.database import make_engine
from app.models import (
    CaptureContent,
    CapturePiece,
    CaptureRow,
    HumanoidRow,
    WalkingModelRow,
    WalkSetRow,
)

PIECE_BYTES = 256 * 1024
LEVEL = 6
"""Compresses text to a fifth within a second or two; higher levels hardly improve on that."""
FAST_LEVEL = 3
"""The level for small files stored at a start: a quarter of the time, and no larger for meshes."""


def compress(file: Path, to: Path) -> None:
    """Compress a file to the format that `store` reads."""
    with file.open("rb") as plain, to.open("wb") as compressed:
        zstandard.ZstdCompressor(level=LEVEL).copy_stream(plain, compressed)


def compressed_beside(path: Path) -> Path:
    """Return the path for the compressed form of an uploaded file."""
    return path.with_name(f"{path.name}.zst")


def store(db: Session, content_hash: str, size: int, compressed: Path) -> None:
    """Store compressed content, unless the database already contains it."""
    with compressed.open("rb") as stream:
        _store(db, content_hash, size, stream)


def _store(db: Session, content_hash: str, size: int, compressed: BinaryIO) -> None:
    insert = (postgresql if db.get_bind().dialect.name == "postgresql" else sqlite).insert
    new = insert(CaptureContent).values(hash=content_hash, size=size)
    if db.execute(new.on_conflict_do_nothing().returning(CaptureContent.hash)).first() is None:
        return
    for number, data in enumerate(iter(lambda: compressed.read(PIECE_BYTES), b"")):
        db.add(CapturePiece(hash=content_hash, number=number, data=data))
        db.flush()
        db.expunge_all()


def store_bytes(db: Session, content_hash: str, data: bytes) -> None:
    """Compress and store a small file, unless the database already contains it."""
    compressed = zstandard.ZstdCompressor(level=FAST_LEVEL).compress(data)
    _store(db, content_hash, len(data), BytesIO(compressed))


def plain_pieces(db: Session, content_hash: str) -> Iterator[bytes]:
    """Yield the file as it was uploaded, in pieces."""
    decompressor = zstandard.ZstdDecompressor().decompressobj()
    query = select(CapturePiece.data).where(CapturePiece.hash == content_hash)
    # Fetched in small batches, so that the file is never completely in memory.
    for data in db.scalars(query.order_by(CapturePiece.number).execution_options(yield_per=4)):
        plain = decompressor.decompress(data)
        if plain:
            yield plain


def stored_files(url: str, hashes: Iterable[str]) -> dict[str, bytes]:
    """Read whole files from the database at a URL, as a worker process does; by content hash.

    A file that is not stored is empty.
    """
    pooled = make_url(url).get_backend_name() != "sqlite"
    engine = make_engine(url, pooled=pooled)
    try:
        with Session(engine) as db:
            return {one: b"".join(plain_pieces(db, one)) for one in hashes}
    finally:
        engine.dispose()


def size_of(db: Session, content_hash: str) -> int:
    """Return the size in bytes of the file as it was uploaded."""
    return db.scalars(select(CaptureContent.size).where(CaptureContent.hash == content_hash)).one()


def drop_unused(db: Session, content_hash: str) -> None:
    """Delete stored content that no capture, humanoid model, set of walks or walking model uses."""
    captures = select(CaptureRow.id).where(
        or_(CaptureRow.content_hash == content_hash, CaptureRow.companion_hash == content_hash)
    )
    models = select(HumanoidRow.hash).where(HumanoidRow.hash == content_hash)
    walks = select(WalkSetRow.id).where(WalkSetRow.content_hash == content_hash)
    walking = select(WalkingModelRow.id).where(WalkingModelRow.content_hash == content_hash)
    every = (captures, models, walks, walking)
    if any(db.scalars(users.limit(1)).first() is not None for users in every):
        return
    db.execute(delete(CapturePiece).where(CapturePiece.hash == content_hash))
    db.execute(delete(CaptureContent).where(CaptureContent.hash == content_hash))
