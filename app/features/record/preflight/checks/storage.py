"""Check by a test write that data reach the disk, and that the disk has enough free space."""

import os
import secrets
from datetime import datetime
from pathlib import Path

from anyio.to_thread import run_sync
from sqlalchemy import delete, select
from sqlalchemy.exc import SQLAlchemyError
from sqlalchemy.orm import Session

from app.database import Database
from app.errors import NotDurable
from app.features.record.preflight.check import (
    Finding,
    Found,
    Situation,
    StateCheck,
    TrialCheck,
)
from app.models import SessionContent
from app.platform.context import AppContext
from app.platform.trouble import explain
from app.texts import Words

KIND = "write_test"
WRITTEN_BYTES = 64 * 1024
"""The size of the test row and file: about a second of movement."""
NS_PER_MS = 1e6
BYTES_PER_GB = 1e9


class DiffersError(Exception):
    """The data that were read back differ from those that were written."""


async def _written(context: AppContext, session_id: str) -> Found:
    """Check that a row and a file can be written, flushed to disk, read back and removed."""
    start_ns = context.clock.monotonic_ns()
    try:
        await write_and_read_back(context, session_id)
    except DiffersError:
        return Found("differs")
    except (SQLAlchemyError, NotDurable, OSError) as error:
        trouble = explain(error)
        message = str(error)[:200] if trouble is None else trouble.message
        return Found("failing", details=(message,))
    took_ms = (context.clock.monotonic_ns() - start_ns) / NS_PER_MS
    return Found("ok", value=round(took_ms, 1), unit="ms")


async def write_and_read_back(context: AppContext, session_id: str) -> None:
    """Write a test row and a test file, read them back, and remove them.

    Raises DiffersError, or the error of the database or the file system.
    """
    text = secrets.token_hex(WRITTEN_BYTES // 2)
    database = context.database
    async with database.writing_async() as db:
        row_id = await run_sync(_put, db, session_id, text, context.clock.utc_now())
    try:
        await run_sync(_compare, database, row_id, text)
    finally:
        async with database.writing_async() as db:
            await run_sync(db.execute, delete(SessionContent).where(SessionContent.id == row_id))
    await run_sync(_file, context.settings.data_dir, text.encode())


def _put(db: Session, session_id: str, text: str, now: datetime) -> str:
    # First remove what an earlier test may have left behind in a crash.
    db.execute(
        delete(SessionContent).where(
            SessionContent.session_id == session_id, SessionContent.kind == KIND
        )
    )
    row = SessionContent(
        session_id=session_id,
        kind=KIND,
        salt=None,
        body=text,
        created_at=now,
        created_by="server",
    )
    db.add(row)
    db.flush()
    return row.id


def _compare(database: Database, row_id: str, text: str) -> None:
    with database.reading() as db:
        if db.scalar(select(SessionContent.body).where(SessionContent.id == row_id)) != text:
            raise DiffersError


def _file(folder: Path, content: bytes) -> None:
    if not folder.is_dir():
        return  # The data are on a database server, so there is no local folder to test.
    file = folder / f".write-test-{secrets.token_hex(8)}"
    try:
        with file.open("wb") as out:
            out.write(content)
            out.flush()
            os.fsync(out.fileno())
        if file.read_bytes() != content:
            raise DiffersError
    finally:
        file.unlink(missing_ok=True)


STORAGE = TrialCheck(
    key="storage",
    title=Words(en="Test write", de="Schreibtest"),
    findings=(
        Finding(
            "failing",
            "fail",
            Words(en="Cannot write to the disk", de="Auf die Platte kann nicht geschrieben werden"),
            remedy=Words(
                en="Free some space, or reconnect the disk. Until then, nothing can be recorded.",
                de="Schaffen Sie Platz oder schließen Sie die Platte wieder an. Bis dahin kann "
                "nichts aufgezeichnet werden.",
            ),
        ),
        Finding(
            "differs",
            "fail",
            Words(
                en="The data read back differ from the data written",
                de="Gelesene und geschriebene Daten unterscheiden sich",
            ),
            remedy=Words(
                en="Do not start. Check the disk, then restart the server.",
                de="Starten Sie nicht. Prüfen Sie die Platte und starten Sie dann den Server neu.",
            ),
        ),
        Finding(
            "ok",
            "ok",
            Words(
                en="Written, read back and compared in {{value}}",
                de="In {{value}} geschrieben, gelesen und verglichen",
            ),
        ),
    ),
    attempt=_written,
)


def _disk(situation: Situation) -> Found:
    storage = situation.context.storage
    try:
        free = storage.free_bytes(storage.folder)
    except OSError:
        return Found("elsewhere")
    return Found(
        "low" if free < storage.low_disk_bytes else "ok",
        value=round(free / BYTES_PER_GB, 1),
        unit="GB",
        expected="at_least",
        limit=round(storage.low_disk_bytes / BYTES_PER_GB, 1),
    )


DISK = StateCheck(
    key="disk",
    title=Words(en="Disk", de="Platte"),
    findings=(
        Finding(
            "low",
            "fail",
            Words(en="{{value}} free", de="{{value}} frei"),
            remedy=Words(
                en="Free some space before you record a session.",
                de="Schaffen Sie Platz, bevor Sie eine Sitzung aufzeichnen.",
            ),
        ),
        Finding(
            "elsewhere", "ok", Words(en="On a database server", de="Auf einem Datenbankserver")
        ),
        Finding("ok", "ok", Words(en="{{value}} free", de="{{value}} frei")),
    ),
    run=_disk,
)
