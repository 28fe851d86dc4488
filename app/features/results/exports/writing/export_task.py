"""Make an export as a file, in a worker process.

A thread of the server would delay running sessions, since Python computes in one thread at a time;
the process has a lower priority. It reads one moment of the database (a read transaction, which
blocks nobody) and writes the archive piece by piece, so that its memory does not grow with the
amount of data. The file gets its final name once it is complete and on the disk.
"""

import hashlib
import os
import shutil
from collections.abc import Iterable, Iterator

from sqlalchemy import func, select
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from app.database import Database, make_engine
from app.errors import ReembodyError
from app.features.design.studies import study_by_key
from app.features.results.analysis.tables import of_kind
from app.features.results.exports.worker_messages import (
    ExportFailure,
    ExportOrder,
    ExportResult,
    Meter,
    Progress,
)
from app.features.results.exports.writing.archive import zip_pieces
from app.features.results.exports.writing.contents import Contents, Member
from app.models import StudySession, TelemetryStream
from app.platform.trouble import explain
from app.wire import StreamName

CHECK_EVERY_BYTES = 32 * 1024**2
"""The disk's free space is checked each time this many bytes were written."""


class _DiskNearlyFullError(Exception):
    """The disk has only as much space left as is reserved for running sessions."""


def make_export(order: ExportOrder) -> ExportResult | ExportFailure:
    """Write the file, or return why it could not be made; the caller removes an unfinished file."""
    try:
        return _write_export(order)
    except _DiskNearlyFullError:
        return _no_room(order)
    except ReembodyError as error:
        return ExportFailure(error.message, error.remedy)
    except (OSError, SQLAlchemyError) as error:
        return _not_written(error)


def _write_export(order: ExportOrder) -> ExportResult:
    database = Database(make_engine(order.url, pooled=False))
    progress, digest = Progress(), hashlib.sha256()
    try:
        with database.reading() as db, order.to.with_suffix(".part").open("xb") as file:
            only = None if order.session_id is None else frozenset({order.session_id})
            _expect(db, order, progress)
            contents = Contents(
                *(db, order.study_key, order.kind, order.now), only, movement=order.movement
            )
            members = watched(contents.members(), progress)
            for piece in zip_pieces(members, order.now):
                file.write(piece)
                digest.update(piece)
                before, progress.bytes = progress.bytes, progress.bytes + len(piece)
                if progress.bytes // CHECK_EVERY_BYTES > before // CHECK_EVERY_BYTES:
                    _require_room(order)
                Meter(order.meter).write(progress)
            file.flush()
            os.fsync(file.fileno())
    finally:
        database.close()
    order.to.with_suffix(".part").rename(order.to)
    return ExportResult(progress.bytes, digest.hexdigest(), contents.sessions, contents.revealed)


def watched(members: Iterable[Member], progress: Progress) -> Iterator[Member]:
    """Yield the given members, and count rows and sessions in `progress` as they are written."""
    for member in members:
        yield (
            Member(member.path, _counted(member.pieces, progress))
            if member.path.startswith("samples/")
            else member
        )


def _counted(pieces: Iterator[bytes], progress: Progress) -> Iterator[bytes]:
    header = 1
    for piece in pieces:
        progress.rows += piece.count(b"\n") - header
        header = 0
        yield piece
    progress.sessions += 1


def _expect(db: Session, order: ExportOrder, progress: Progress) -> None:
    """Set the totals of sessions and rows in `progress`.

    The rows of a session's run are those of its longer stream.
    """
    study = study_by_key(db, order.study_key)
    session_ids = select(StudySession.id).where(of_kind(study, order.kind))
    if order.session_id is not None:
        session_ids = session_ids.where(StudySession.id == order.session_id)
    stream = TelemetryStream
    longest = (
        select(func.max(stream.frames_stored).label("rows"))
        .where(stream.session_id.in_(session_ids))
        .where(stream.stream.in_([StreamName.TARGET, StreamName.ACTUAL]))
        .group_by(stream.session_id, stream.epoch)
        .subquery()
    )
    progress.sessions_total = (
        db.scalar(select(func.count()).select_from(session_ids.subquery())) or 0
    )
    if order.movement:
        progress.rows_total = int(db.scalar(select(func.sum(longest.c.rows))) or 0)
    Meter(order.meter).write(progress)
    _require_room(order)


def _require_room(order: ExportOrder) -> None:
    if shutil.disk_usage(order.to.parent).free < order.keep_free_bytes:
        raise _DiskNearlyFullError


def _not_written(error: OSError | SQLAlchemyError) -> ExportFailure:
    trouble = explain(error)
    if trouble is not None:
        return ExportFailure(
            f"the export could not be written: {trouble.message}",
            f"{trouble.remedy} Then make the export again.",
        )
    return ExportFailure(
        f"the export could not be written: {type(error).__name__}: {str(error)[:200]}",
        "Make it again; if that fails, too, check the server's disk and database.",
    )


def _no_room(order: ExportOrder) -> ExportFailure:
    keep_gb = order.keep_free_bytes / 1e9
    return ExportFailure(
        f"the disk has less than {keep_gb:.1f} GB left, which is reserved for running sessions",
        "Free space on the server's disk (the page Storage shows what uses it), or export to "
        "another disk on the server: ./run export --to FOLDER.",
    )
