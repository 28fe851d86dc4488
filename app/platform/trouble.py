"""What a refusal of the database or the disk means, in words for people, with the way out."""

import errno
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

from sqlalchemy.exc import DBAPIError, OperationalError

from app.errors import DamagedValue, NotDurable


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
NOT_ALLOWED = Trouble(
    "the system does not allow it",
    "Check that the folder is there, and that who runs this may read and write it.",
)
WORN = Trouble(
    "the disk cannot be read or written", "Check the disk: it may be unplugged or broken."
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
_BY_ERRNO = {
    errno.ENOSPC: FULL,
    errno.EDQUOT: FULL,
    errno.EFBIG: FULL,
    errno.EACCES: NOT_ALLOWED,
    errno.EPERM: NOT_ALLOWED,
    errno.EROFS: NOT_ALLOWED,
    errno.EIO: WORN,
}
_DISK_FULL_STATE = "53100"
_STORAGE_STATES = ("08", "53", "57P", "58", "XX001", "XX002")
"""PostgreSQL (appendix A of its manual): connection, resources, shutdown, system, damage."""


def explain(error: Exception) -> Trouble | None:
    """What a refusal of the database or the disk means, in words for people.

    None if storage is not at fault, as in a deadlock, or when a constraint is violated.
    """
    if isinstance(error, OSError):
        return _BY_ERRNO.get(error.errno or 0)
    if proves_damage(error):
        return DAMAGED
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


def proves_damage(error: Exception) -> bool:
    """Whether an error of SQLite's shows that the file itself is damaged, not that it is held up.

    Damage can make SQLite's own message undecodable: then Python's driver raises UnicodeDecodeError
    in its place, or an error without a code where a stored text cannot be decoded. Ours is that a
    stored text is no time.
    """
    origin = error.orig if isinstance(error, DBAPIError) else error
    if isinstance(origin, UnicodeDecodeError | DamagedValue):
        return True
    if not isinstance(origin, sqlite3.Error):
        return False
    code = getattr(origin, "sqlite_errorcode", None)
    if code is None:
        return "decode" in str(origin)
    return code & 0xFF in (sqlite3.SQLITE_CORRUPT, sqlite3.SQLITE_NOTADB)


@contextmanager
def plainly(what: str) -> Iterator[None]:
    """Raise NotDurable in place of what a disk or a database refuses, as one sentence.

    `what` begins it, as in "the database FILE cannot be opened". Other errors pass.
    """
    try:
        yield
    except (OSError, sqlite3.Error, DBAPIError, UnicodeDecodeError) as error:
        raise in_plain_words(what, error) from error


def in_plain_words(what: str, error: Exception) -> NotDurable:
    """The error that `plainly` raises for `error`."""
    if isinstance(error, OSError):
        trouble = _BY_ERRNO.get(error.errno or 0, REFUSED)
        return NotDurable(f"{what}: {error.strerror or error}", remedy=trouble.remedy)
    if proves_damage(error):
        return NotDurable(f"{what}: {DAMAGED.message}", remedy=DAMAGED.remedy)
    said = str(getattr(error, "orig", None) or error).strip().partition("\n")[0]
    found = explain(error)
    return NotDurable(f"{what}: {said}", remedy=(found or REFUSED).remedy)
