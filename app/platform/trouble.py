"""What a refusal of the database means, in words for people, with the way out."""

import sqlite3
from typing import NamedTuple

from sqlalchemy.exc import DBAPIError, OperationalError


class Trouble(NamedTuple):
    """What keeps the record from being written, and what to do."""

    message: str
    remedy: str


FULL = Trouble(
    "the disk of the server is full",
    "Free space on the disk that holds the data folder. Everything goes on by itself then.",
)
LOCKED = Trouble(
    "another program holds the database",
    "Close what has the database open (a viewer, a backup, a file sync). It goes on by itself.",
)
READ_ONLY = Trouble(
    "the database cannot be opened for writing",
    "Check that the data folder is there and that the server may write to it.",
)
DAMAGED = Trouble(
    "the database is damaged",
    "Stop the server, keep the data folder as it is, and restore the newest backup.",
)
REFUSED = Trouble(
    "the disk or the database does not take what is written",
    "Check the disk of the server: it may be full, over a quota, unplugged or broken.",
)
BUSY = Trouble("two transactions were in each other's way", "Nothing has to be mended.")

_BY_SQLITE_CODE = {
    sqlite3.SQLITE_FULL: FULL,
    sqlite3.SQLITE_BUSY: LOCKED,
    sqlite3.SQLITE_LOCKED: LOCKED,
    sqlite3.SQLITE_READONLY: READ_ONLY,
    sqlite3.SQLITE_CANTOPEN: READ_ONLY,
    sqlite3.SQLITE_CORRUPT: DAMAGED,
    sqlite3.SQLITE_NOTADB: DAMAGED,
    sqlite3.SQLITE_IOERR: REFUSED,
    sqlite3.SQLITE_PROTOCOL: LOCKED,
}
_DISK_FULL_STATE = "53100"
_STORAGE_STATES = ("08", "53", "57P", "58", "XX001", "XX002")
"""PostgreSQL (appendix A of its manual): connection, resources, shutdown, system, damage."""


def explain(error: Exception) -> Trouble | None:
    """What a refusal of the database means, in words for people; None if storage is not at fault,
    as in a deadlock, or when a constraint is violated.
    """
    origin = error.orig if isinstance(error, DBAPIError) else error
    code = getattr(origin, "sqlite_errorcode", None)
    if isinstance(code, int):
        return _BY_SQLITE_CODE.get(code & 0xFF)
    state = getattr(origin, "sqlstate", None)
    if state == _DISK_FULL_STATE:
        return FULL
    if isinstance(state, str):
        return REFUSED if state.startswith(_STORAGE_STATES) else None
    # Without a code: the connection to the database server is gone.
    return REFUSED if isinstance(error, OperationalError) else None
