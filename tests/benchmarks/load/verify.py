"""Compare the database with the generator's own counters and digests."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from datetime import datetime
from heapq import merge
from pathlib import Path
from typing import Any, TypeVar

from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.database import Database, open_database
from app.features.record.telemetry import Frames
from app.features.record.telemetry.encoding import decode_frames
from app.models import AlarmRow, ClientReport, TelemetryBatch, TelemetryChunk
from app.wire import BODY_STREAMS, decode_batch
from app.wire.messages import REPORT_STREAM
from tests.benchmarks.load.record import Digest

Span = tuple[int, int]
Piece = TelemetryChunk | TelemetryBatch
Row = TypeVar("Row", TelemetryChunk, TelemetryBatch)


@dataclass
class Verdict:
    """The numbers of frames and reports sent, acknowledged and stored, and the problems found.

    `lost` were acknowledged and are not stored, `duplicated` are stored more than once, `surplus`
    were never sent. `digested`, `differing`: streams that were compared bit by bit. `alarms`: the
    alarms that the server raised during the load.
    """

    handed: int = 0
    acked: int = 0
    stored: int = 0
    lost: int = 0
    duplicated: int = 0
    surplus: int = 0
    digested: int = 0
    differing: int = 0
    alarms: int = 0
    batches_left: int = 0
    chunk_bytes: int = 0
    chunk_frames: int = 0


def verify(
    url: str, sessions: list[Mapping[str, Any]], lasted: tuple[datetime, datetime] | None = None
) -> Verdict:
    """Compare every stream's rows with the acknowledgements, and the digested ones bit by bit.

    `lasted`: when the load began and ended. Headsets that wait for each other before, and leave
    afterwards, raise alarms too.
    """
    verdict = Verdict()
    database = open_database(url)
    try:
        _measure(database, verdict, lasted)
        for told in sessions:
            for stream in (*BODY_STREAMS, REPORT_STREAM):
                _count(database, told, str(stream), verdict)
            for stream, digest in told["digests"].items():
                verdict.digested += 1
                verdict.differing += _digest(database, told, stream) != digest
    finally:
        database.close()
    return verdict


def database_bytes(url: str) -> int:
    """Return the size of the database on disk, after its server has stopped."""
    database = open_database(url)
    try:
        with database.reading() as db:
            if db.get_bind().dialect.name == "sqlite":
                return Path(url.removeprefix("sqlite:///")).stat().st_size
            return int(db.scalar(select(func.pg_database_size(func.current_database()))) or 0)
    finally:
        database.close()


def _measure(
    database: Database, verdict: Verdict, lasted: tuple[datetime, datetime] | None
) -> None:
    with database.reading() as db:
        size = func.sum(func.length(TelemetryChunk.data))
        found = db.execute(select(size, func.sum(TelemetryChunk.frame_count))).one()
        verdict.chunk_bytes, verdict.chunk_frames = found[0] or 0, found[1] or 0
        raised = select(func.count()).where(AlarmRow.state == "raised")
        if lasted is not None:
            raised = raised.where(AlarmRow.at.between(*lasted))
        verdict.alarms = db.scalar(raised) or 0
        verdict.batches_left = db.scalar(select(func.count()).select_from(TelemetryBatch)) or 0


def _count(database: Database, told: Mapping[str, Any], stream: str, verdict: Verdict) -> None:
    with database.reading() as db:
        spans = sorted(_spans(db, told["session_id"], stream, told["epoch"]))
    end = missing = 0
    for first, after in spans:
        verdict.duplicated += max(0, min(end, after) - first)
        missing += max(0, min(first, told["acked"][stream]) - end)
        verdict.stored += after - first
        end = max(end, after)
    verdict.handed += told["handed"][stream]
    verdict.acked += told["acked"][stream]
    verdict.lost += missing + max(0, told["acked"][stream] - end)
    verdict.surplus += max(0, end - told["handed"][stream])


def _spans(db: Session, session_id: str, stream: str, epoch: int) -> Iterator[Span]:
    """Return every stored row of a stream as (first seq, one past the last)."""
    if stream == REPORT_STREAM:
        query = select(ClientReport.seq).where(
            ClientReport.session_id == session_id, ClientReport.epoch == epoch
        )
        yield from ((seq, seq + 1) for seq in db.scalars(query))
        return
    for table in (TelemetryChunk, TelemetryBatch):
        rows = select(table.seq_first, table.frame_count).where(
            table.session_id == session_id, table.stream == stream, table.epoch == epoch
        )
        yield from ((first, first + count) for first, count in db.execute(rows))


def _digest(database: Database, told: Mapping[str, Any], stream: str) -> str:
    """Digest the stored data of a stream, in order of seq, without the product's own reader."""
    digest = Digest()
    with database.reading() as db:
        rows: Iterator[Piece] = merge(
            _rows(db, TelemetryChunk, told, stream),
            _rows(db, TelemetryBatch, told, stream),
            key=lambda row: row.seq_first,
        )
        for row in rows:
            if isinstance(row, TelemetryBatch):
                batch = decode_batch(row.message)
                digest.take(batch.times_s, batch.flags, batch.values)
            else:
                frames = _decoded(row)
                digest.take(frames.times_s, frames.flags, frames.values)
    return digest.text


def _rows(db: Session, table: type[Row], told: Mapping[str, Any], stream: str) -> Iterator[Row]:
    query = (
        select(table)
        .where(
            table.session_id == told["session_id"],
            table.stream == stream,
            table.epoch == told["epoch"],
        )
        .order_by(table.seq_first)
    )
    return iter(db.scalars(query.execution_options(yield_per=64)))


def _decoded(chunk: TelemetryChunk) -> Frames:
    return decode_frames(
        chunk.data,
        encoding=chunk.encoding,
        seq_first=chunk.seq_first,
        frame_count=chunk.frame_count,
        values_per_frame=chunk.values_per_frame,
    )
