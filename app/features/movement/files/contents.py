"""Files in the database: compressed, in pieces, once by the hash of what they hold."""

from collections.abc import Iterator
from pathlib import Path

import zstandard
from sqlalchemy import delete, or_, select
from sqlalchemy.dialects import postgresql, sqlite
from sqlalchemy.orm import Session

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
"""Text shrinks to a fifth within a second or two; higher levels hardly gain."""


def compress(file: Path, to: Path) -> None:
    """Make the stream that `store` takes."""
    with file.open("rb") as plain, to.open("wb") as compressed:
        zstandard.ZstdCompressor(level=LEVEL).copy_stream(plain, compressed)


def compressed_beside(path: Path) -> Path:
    """Where the compressed form of an uploaded file is put."""
    return path.with_name(f"{path.name}.zst")


def store(db: Session, content_hash: str, size: int, compressed: Path) -> None:
    """Keep a content, unless it is here already."""
    insert = (postgresql if db.get_bind().dialect.name == "postgresql" else sqlite).insert
    new = insert(CaptureContent).values(hash=content_hash, size=size)
    if db.execute(new.on_conflict_do_nothing().returning(CaptureContent.hash)).first() is None:
        return
    with compressed.open("rb") as stream:
        for number, data in enumerate(iter(lambda: stream.read(PIECE_BYTES), b"")):
            db.add(CapturePiece(hash=content_hash, number=number, data=data))
            db.flush()
            db.expunge_all()


def plain_pieces(db: Session, content_hash: str) -> Iterator[bytes]:
    """The file as it was uploaded, piece by piece."""
    decompressor = zstandard.ZstdDecompressor().decompressobj()
    query = select(CapturePiece.data).where(CapturePiece.hash == content_hash)
    # One after the other: all of them at once would be the whole file in memory.
    for data in db.scalars(query.order_by(CapturePiece.number).execution_options(yield_per=4)):
        plain = decompressor.decompress(data)
        if plain:
            yield plain


def size_of(db: Session, content_hash: str) -> int:
    """Bytes of the file as it was uploaded."""
    return db.scalars(select(CaptureContent.size).where(CaptureContent.hash == content_hash)).one()


def drop_unused(db: Session, content_hash: str) -> None:
    """Delete a content that no capture, humanoid model or model of walking uses any more."""
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
