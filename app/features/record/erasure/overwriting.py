"""Overwrite the bytes that a database retains of deleted rows.

SQLite overwrites deleted rows with zeros (`secure_delete`), but copies of them can remain in three
places: in its write-ahead log, in pages that were freed by earlier versions of the product, and in
the gaps of pages whose rows were moved when others were inserted. So after an erasure the log is
checkpointed and truncated, and the file is rewritten (VACUUM). The latter blocks writers, so it is
postponed to the next start of the server if a session is running or if the disk has no room for a
second copy. A marker file in the data folder records that it is pending, even across a crash.

On PostgreSQL, the affected tables are vacuumed. See docs/participants-rights.md for what that
leaves behind.
"""

import logging
import shutil
import sqlite3
import time
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.exc import DBAPIError

from app.database import Database
from app.features.record.erasure.traces import TOUCHED
from app.models import ImportedForm, Participant, StudySession
from app.platform.folders import home_of
from app.settings import Settings

log = logging.getLogger(__name__)
MARKER = "erasure-unfinished"
TRIES, PAUSE_S, READER_MS = 40, 0.5, 100
"""How often to try to cut the log, the pause between, and the wait for a reader each time."""
ROOM = 1.2
"""Rewriting the database needs this many times its size as free space."""


def mark_erasure(settings: Settings) -> bool:
    """Create the marker file, before rows are deleted; return whether it is new.

    The marker records that the bytes of deleted rows must be overwritten.
    """
    marker = _marker(settings)
    new = not marker.exists()
    marker.parent.mkdir(parents=True, exist_ok=True)
    marker.touch()
    return new


def is_overwritten(settings: Settings) -> bool:
    """Return whether the database contains no more bytes of erased rows."""
    return not _marker(settings).exists()


def clear_erasure_mark(settings: Settings) -> None:
    """Remove the marker file, because nothing is left to overwrite.

    If it cannot be removed, that is only logged: the next start then overwrites once more.
    """
    try:
        _marker(settings).unlink(missing_ok=True)
    except OSError as error:
        log.warning("the erasure marker remains; the next start will overwrite again: %s", error)


def overwrite(database: Database, settings: Settings, *, starting: bool = False) -> bool:
    """Overwrite what the erased rows left behind; return whether nothing is left to do.

    Call this outside any transaction. What cannot be done now is done at the next start.
    `starting`: the server is starting, so a running session is no reason to postpone.
    """
    try:
        done = _overwrite(database, starting=starting)
        if done:
            clear_erasure_mark(settings)
    except (DBAPIError, sqlite3.Error, OSError) as error:
        cause = getattr(error, "orig", error)
        log.warning("erased rows could not be overwritten yet: %s", cause)
        return False
    return done and is_overwritten(settings)


def finish_overwriting(database: Database, settings: Settings) -> bool:
    """Finish a pending overwrite when the server starts; return whether one was pending."""
    if is_overwritten(settings):
        return False
    overwrite(database, settings, starting=True)
    return True


def _overwrite(database: Database, *, starting: bool) -> bool:
    if database.is_sqlite:
        return _sqlite(database, starting=starting)
    return _postgresql(database)


def _marker(settings: Settings) -> Path:
    return home_of(settings) / MARKER


def _sqlite(database: Database, *, starting: bool) -> bool:
    """Cut the log, rewrite the file and cut the log again; try for a while if a reader uses it.

    Writers wait for one attempt at a time, and not for the reader, who may go on for long.
    """
    is_rewritten = False
    for attempt in range(TRIES):
        if attempt > 0:
            time.sleep(PAUSE_S)
        with database.commits.copying, database.write_turn():
            if not _cut_log(database):
                continue
            may_rewrite = starting or _no_session_runs(database)
            if not is_rewritten and may_rewrite and _has_room(database):
                _execute(database, "VACUUM")
                is_rewritten = True
                if not _cut_log(database):
                    continue
            database.commits.copied = database.commits.number
            return is_rewritten
    log.warning("the write-ahead log could not be truncated: a reader is still using it")
    return False


def _cut_log(database: Database) -> bool:
    """Checkpoint the whole log and truncate it; return False if a reader is still using it."""
    connection = database.engine.raw_connection()
    try:
        cursor = connection.cursor()
        usual_ms = cursor.execute("PRAGMA busy_timeout").fetchone()[0]
        try:
            cursor.execute(f"PRAGMA busy_timeout={READER_MS}")
            busy = cursor.execute("PRAGMA wal_checkpoint(TRUNCATE)").fetchone()[0]
            return not busy
        finally:
            cursor.execute(f"PRAGMA busy_timeout={usual_ms}")
    finally:
        connection.close()


def _no_session_runs(database: Database) -> bool:
    with database.reading() as db:
        running = select(StudySession.id).where(StudySession.status == "active").limit(1)
        return db.scalar(running) is None


def _has_room(database: Database) -> bool:
    file = Path(str(database.engine.url.database))
    return shutil.disk_usage(file.absolute().parent).free > ROOM * file.stat().st_size


def _postgresql(database: Database) -> bool:
    with database.engine.connect().execution_options(isolation_level="AUTOCOMMIT") as connection:
        for table in (*TOUCHED, ImportedForm.__tablename__, Participant.__tablename__):
            connection.exec_driver_sql(f'VACUUM "{table}"')
    return True


def _execute(database: Database, statement: str) -> None:
    """Execute a statement outside the transaction that the engine would otherwise open."""
    connection = database.engine.raw_connection()
    try:
        connection.cursor().execute(statement)
    finally:
        connection.close()
