"""The bytes: what a database keeps of rows that are gone.

SQLite overwrites deleted rows with zeros (`secure_delete`), but copies of them can be left in three
places: in its write-ahead log, in pages that were freed by earlier versions of the product, and in
the gaps of pages whose rows were moved when others came. So after an erasure the log is copied and
cut to nothing, and the file is written anew (VACUUM). The latter holds writers up, so it waits for
the next start of the server if a session is running now, or if the disk has no room for a second
copy; a marker in the data folder remembers it, also over a crash.

PostgreSQL gets a VACUUM of the tables that were touched. See docs/participants-rights.md for what
that leaves.
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
TRIES, PAUSE_S = 20, 0.25
ROOM = 1.2
"""How much of the database's size must be free to write it anew."""


def expect_erasure(settings: Settings) -> bool:
    """Remember that bytes will have to be overwritten, before the rows go; whether that is new."""
    marker = _marker(settings)
    new = not marker.exists()
    marker.parent.mkdir(parents=True, exist_ok=True)
    marker.touch()
    return new


def is_overwritten(settings: Settings) -> bool:
    """Whether no byte of erased rows is left in the database."""
    return not _marker(settings).exists()


def forget_erasure(settings: Settings) -> None:
    """Nothing is to be overwritten, or nothing any more.

    A mark that cannot be removed is no reason to fail: the next start overwrites once more.
    """
    try:
        _marker(settings).unlink(missing_ok=True)
    except OSError as error:
        log.warning("the mark of an erasure stays, and the next start overwrites again: %s", error)


def overwrite(database: Database, settings: Settings, *, starting: bool = False) -> bool:
    """Overwrite what the erased rows left behind; whether nothing is left to do.

    Call it outside of any transaction. What could not be done now is done at the next start;
    `starting`: this is it, and no session is held up.
    """
    try:
        done = _anew(database, starting=starting)
        if done:
            forget_erasure(settings)
    except (DBAPIError, sqlite3.Error, OSError) as error:
        words = getattr(error, "orig", error)
        log.warning("erased rows are still to be overwritten: %s", words)
        return False
    return done and is_overwritten(settings)


def overwrite_what_is_left(database: Database, settings: Settings) -> bool:
    """At a start: finish what an earlier erasure could not; whether there was anything."""
    if is_overwritten(settings):
        return False
    overwrite(database, settings, starting=True)
    return True


def _anew(database: Database, *, starting: bool) -> bool:
    if database.is_sqlite:
        return _sqlite(database, starting=starting)
    return _postgresql(database)


def _marker(settings: Settings) -> Path:
    return home_of(settings) / MARKER


def _sqlite(database: Database, *, starting: bool) -> bool:
    # Nobody else copies the log, and nobody writes, from the first cut to the last.
    with database.commits.copying, database.write_turn():
        cut = _cut_log(database)
        anew = cut and (starting or _nobody_waits(database)) and _has_room(database)
        if anew:
            _execute(database, "VACUUM")
            cut = _cut_log(database)
        if cut:
            database.commits.copied = database.commits.number
    return cut and anew


def _cut_log(database: Database) -> bool:
    """Copy the whole log and cut it to nothing; a reader may be in the way for a moment."""
    for _ in range(TRIES):
        busy, *_rest = _execute(database, "PRAGMA wal_checkpoint(TRUNCATE)") or (0,)
        if not busy:
            return True
        time.sleep(PAUSE_S)
    log.warning("the log could not be cut: somebody reads for long")
    return False


def _nobody_waits(database: Database) -> bool:
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


def _execute(database: Database, statement: str) -> tuple[int, ...] | None:
    """Outside of any transaction, which the engine would open."""
    connection = database.engine.raw_connection()
    try:
        cursor = connection.cursor()
        cursor.execute(statement)
        row = cursor.fetchone() if cursor.description else None
        return None if row is None else tuple(row)
    finally:
        connection.close()
