"""Explain errors of the database or the disk to people, with a remedy."""

import errno
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager
from typing import NamedTuple

from sqlalchemy.exc import DBAPIError, OperationalError

from app.errors import DamagedValue, NotDurable


class Trouble(NamedTuple):
    """The reason why the record cannot be written, and the remedy."""

    message: str
    remedy: str


FULL = Trouble(
    "the disk of the server is full",
    "Free space on the disk of the data folder. Storage then resumes automatically.",
)
LOCKED = Trouble(
    "another program has locked the database",
    "Close what has it open (a viewer, a backup, a file sync). Storage then resumes automatically.",
)
READ_ONLY = Trouble(
    "the database cannot be opened for writing",
    "Check that the data folder exists and that the server may write to it.",
)
DAMAGED = Trouble(
    "the database is damaged",
    "Stop the server, keep the data folder as it is, and restore the newest backup.",
)
REFUSED = Trouble(
    "the disk or the database rejects writes",
    "Check the disk of the server: it may be full, over a quota, unplugged or broken.",
)
NOT_ALLOWED = Trouble(
    "the operating system denied access",
    "Check that the folder exists, and that your account may read and write it.",
)
WORN = Trouble(
    "the disk cannot be read or written", "Check the disk: it may be unplugged or broken."
)
BUSY = Trouble("two transactions conflicted", "Nothing needs to be repaired.")

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
"""PostgreSQL error codes (appendix A): connection, resources, shutdown, system, damage."""


def explain(error: Exception) -> Trouble | None:
    """Return the explanation of an error of the database or the disk.

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
    # An error without a code means that the connection to the database server was lost.
    return REFUSED if isinstance(error, OperationalError) else None


def proves_damage(error: Exception) -> bool:
    """Return whether a SQLite error shows that the file itself is damaged, not just unavailable.

    Damage can make SQLite's own message undecodable: then Python's driver raises UnicodeDecodeError
    in its place, or an error without a code if a stored text cannot be decoded. This program raises
    DamagedValue if a stored value cannot be parsed.
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
def errors_as_not_durable(what: str) -> Iterator[None]:
    """Convert errors of a disk or a database to NotDurable with a one-sentence message.

    `what` begins the sentence, as in "the database FILE cannot be opened". Other errors pass.
    """
    try:
        yield
    except (OSError, sqlite3.Error, DBAPIError, UnicodeDecodeError) as error:
        raise not_durable_error(what, error) from error


def not_durable_error(what: str, error: Exception) -> NotDurable:
    """Return the error that `errors_as_not_durable` raises for `error`."""
    if isinstance(error, OSError):
        trouble = _BY_ERRNO.get(error.errno or 0, REFUSED)
        return NotDurable(f"{what}: {error.strerror or error}", remedy=trouble.remedy)
    if proves_damage(error):
        return NotDurable(f"{what}: {DAMAGED.message}", remedy=DAMAGED.remedy)
    reason = str(getattr(error, "orig", None) or error).strip().partition("\n")[0]
    found = explain(error)
    return NotDurable(f"{what}: {reason}", remedy=(found or REFUSED).remedy)
