"""Open the state after a power loss: with SQLite, then as the server's next start would."""

import shutil
import sqlite3
from collections.abc import Iterable, Mapping
from contextlib import closing
from dataclasses import dataclass, replace
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.exc import DatabaseError

from app.clock import Clock
from app.database import open_database
from app.errors import ReembodyError
from app.features.care.opening import prepare_database
from app.models import StudySession, TelemetryStream
from app.settings import Settings
from tests.faults.power.disk import Image
from tests.faults.power.promises import Position, Promise
from tests.rehearsal.ledger import LedgerJournal, reconcile

DATABASE = "reembody.sqlite"


@dataclass(frozen=True)
class Verdict:
    """The comparison of a disk image with the promises.

    `lost`: promised frames, reports and sessions that are missing. `corrupt`: SQLite's report about
    a broken file, empty if the file is sound.
    """

    corrupt: str = ""
    lost: int = 0
    altered: int = 0
    duplicated: int = 0
    holes: int = 0


@dataclass(frozen=True)
class Promised:
    """Everything that was promised up to a given moment."""

    positions: Mapping[Position, int]
    sessions: frozenset[str]


def promised_by(promises: Iterable[Promise], stamp: int) -> Promised:
    """Return everything that had been promised when the call with this stamp began."""
    positions: dict[Position, int] = {}
    sessions = set()
    for promise in promises:
        if promise.began <= stamp:
            sessions |= {promise.session_id} - {""}
            for key, seq in promise.positions.items():
                positions[key] = max(seq, positions.get(key, 0))
    return Promised(positions, frozenset(sessions))


def write_image(folder: Path, image: Image) -> Path:
    """Write an image into an emptied folder and return the path of its database."""
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for name, content in image.items():
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_bytes(content)
    return folder / DATABASE


def positions_in(database: Path) -> dict[Position, int]:
    """Return up to which position each stream is stored; empty if the table does not exist yet."""
    with closing(sqlite3.connect(database)) as connection:
        try:
            rows = connection.execute(
                "SELECT session_id, stream, epoch, next_seq FROM telemetry_streams"
            )
        except sqlite3.OperationalError as error:
            if "no such table" not in str(error):
                raise
            return {}
        return {(session, stream, epoch): seq for session, stream, epoch, seq in rows}


def judge(database: Path, promised: Promised, ledgers: Mapping[str, LedgerJournal]) -> Verdict:
    """Start on an image and compare it with the promises; `ledgers` are the journals by session.

    A start that quarantines the database as damaged counts as corruption, too.
    """
    try:
        prepare_database(Settings(data_dir=database.parent), Clock())
        with closing(sqlite3.connect(database)) as connection:
            (said,) = connection.execute("PRAGMA integrity_check(1)").fetchone()
            strays = connection.execute("PRAGMA foreign_key_check").fetchall()
        if said != "ok" or strays:
            return Verdict(corrupt=f"{said} {strays}")
        return _compared(database, promised, ledgers)
    except (sqlite3.DatabaseError, DatabaseError, ReembodyError, ValueError) as error:
        # A ValueError: the product's own checks of what it reads.
        return Verdict(corrupt=str(error))


def _compared(database: Path, promised: Promised, ledgers: Mapping[str, LedgerJournal]) -> Verdict:
    verdict = Verdict()
    opened = open_database(f"sqlite:///{database}")
    try:
        with opened.reading() as db:
            known = set(db.scalars(select(StudySession.id)))
            stored = {
                (row.session_id, row.stream, row.epoch): row.next_seq
                for row in db.scalars(select(TelemetryStream))
            }
            verdict = replace(verdict, lost=len(promised.sessions - known))
            for session_id in sorted(known & ledgers.keys()):
                acked = {
                    key[1:]: n for key, n in promised.positions.items() if key[0] == session_id
                }
                found = reconcile(db, session_id, replace(ledgers[session_id], acked=acked))
                verdict = Verdict(
                    lost=verdict.lost + found.lost,
                    altered=verdict.altered + found.altered,
                    duplicated=verdict.duplicated + found.duplicated,
                    holes=verdict.holes + found.holes,
                )
    finally:
        opened.close()
    behind = sum(max(0, seq - stored.get(key, 0)) for key, seq in promised.positions.items())
    return replace(verdict, lost=max(verdict.lost, behind))
