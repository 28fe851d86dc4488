"""What is wrong with a SQLite file, found out without changing it.

Use it only in a process that has not opened the file with SQLite: on POSIX, closing any handle on a
file drops the locks that SQLite's own handles hold.
"""

import os
import sqlite3
from contextlib import closing, suppress
from pathlib import Path

from app.features.care.opening.wal import inspect_log

MAGIC = b"SQLite format 3\x00"
ALWAYS_CHECKED_BYTES = 2 * 10**9
"""A larger file is checked page by page only after an unclean end.

Checking takes about 2.5 s for each GB if the disk has to read it, 0.4 s if it is in memory.
"""
_HEADER = 100
_BLOCK = 4 * 1024 * 1024
_SHARED_FIRST, _SHARED_SIZE = 0x40000002, 510
"""The bytes that every process with an open SQLite database holds a lock on in WAL mode."""


def log_of(file: Path) -> Path:
    """The write-ahead log that belongs to a database file."""
    return file.with_name(file.name + "-wal")


def is_open_elsewhere(file: Path) -> bool:
    """Whether another process has the database open; False where the system cannot tell."""
    try:
        import fcntl
    except ImportError:
        return False
    try:
        with file.open("rb+") as handle:
            fcntl.lockf(handle, fcntl.LOCK_EX | fcntl.LOCK_NB, _SHARED_SIZE, _SHARED_FIRST)
    except BlockingIOError:
        return True
    except OSError:  # not ours to write: working with it will say so
        return False
    return False


def damage_of(file: Path) -> str | None:
    """What is wrong with the file in a few words; None if it can be worked with.

    A log left behind, whose end may be torn, is what a power failure leaves and no damage.
    """
    with file.open("rb") as handle:
        start = handle.read(_HEADER)
    if not start.startswith(MAGIC):
        return "it is not a SQLite database" if start else "it is empty (0 bytes)"
    log = log_of(file)
    unclean = log.is_file() and log.stat().st_size > 0
    if not unclean and file.stat().st_size % _page_size(start):
        return "it was cut off"
    report = inspect_log(log)
    if not report.header_fits:
        return "the beginning of its log is damaged"
    if report.damaged:
        return f"its log is damaged: {report.commits_behind} stored transactions cannot be read"
    try:
        return _checked(file, thoroughly=unclean or file.stat().st_size <= ALWAYS_CHECKED_BYTES)
    except sqlite3.DatabaseError as error:
        return str(error)


def foreign_tables(file: Path) -> list[str]:
    """The tables of a database that is somebody else's; none if it is ours, or new."""
    with closing(_read_only(file)) as connection:
        query = "SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name"
        names = [str(name) for (name,) in connection.execute(query)]
    return [] if "alembic_version" in names else names


def _page_size(header: bytes) -> int:
    size = int.from_bytes(header[16:18], "big")
    return 65536 if size == 1 else max(size, 512)


def _checked(file: Path, *, thoroughly: bool) -> str | None:
    if thoroughly:
        _read_through(file)
    with closing(_read_only(file)) as connection:
        # Reading the tables' definitions fails where the file is no database at all.
        connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
        if not thoroughly:
            return None
        (first,) = connection.execute("PRAGMA quick_check(1)").fetchone()
    return None if first == "ok" else str(first)


def _read_through(file: Path) -> None:
    """In one go, from the first byte to the last: checking jumps, and a disk is slow at that."""
    with suppress(OSError):  # checking itself will say where it cannot be read
        handle = os.open(file, os.O_RDONLY)
        try:
            while os.read(handle, _BLOCK):
                pass
        finally:
            os.close(handle)


def _read_only(file: Path) -> sqlite3.Connection:
    # A reader that cannot write leaves the log where it is when it closes.
    return sqlite3.connect(f"{file.absolute().as_uri()}?mode=ro", uri=True, timeout=30.0)
