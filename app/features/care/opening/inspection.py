"""Detect damage of a SQLite file without changing it.

Only damage that the bytes of the file prove is reported. Anything else that prevents reading the
file (permissions, a disk that does not respond, a lock) raises NotDurable instead: then nothing is
known about the database, and it stays where it is.

Use it only in a process that has not opened the file with SQLite: on POSIX, closing any handle of a
file drops the locks that SQLite's own handles hold.
"""

import errno
import os
import re
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from contextlib import closing, contextmanager, suppress
from pathlib import Path

from app.features.care.backups import TableShape, columns_in, shapes_at, wrong_rows, wrong_tables
from app.features.care.opening.wal import frames_noted, inspect_log
from app.platform.trouble import not_durable_error, proves_damage
from app.schema_revisions import VERSION_TABLE, all_revisions, newest_revision
from app.sqlite_connections import BUSY_TIMEOUT_S

MAGIC = b"SQLite format 3\x00"
ALWAYS_CHECKED_BYTES = 2 * 10**9
"""A larger file is checked page by page only after an unclean end.

Checking takes about 2.5 s for each GB if the disk has to read it, 0.4 s if it is in memory.
"""
ROWS_READ_BYTES = 200 * 10**6
"""The rows of a larger file are read only if the database turned out to be unusable."""
UNNAMED = "its schema version is unknown"
UNREADABLE = "its content cannot be read as text"
_HEADER = 100
_BLOCK = 4 * 1024 * 1024
_SHARED_FIRST, _SHARED_SIZE = 0x40000002, 510
"""The byte range that every process with an open SQLite database locks in WAL mode."""
_REVISION = re.compile(r"\d{4}")
_ERROR_CODE = re.compile(r"error code=(\d+)")


def log_of(file: Path) -> Path:
    """Return the path of a database file's write-ahead log."""
    return file.with_name(file.name + "-wal")


def index_of(file: Path) -> Path:
    """Return the path of the log's index, which a killed process leaves behind."""
    return file.with_name(file.name + "-shm")


def is_open_elsewhere(file: Path) -> bool:
    """Return whether another process has the database open; False if that cannot be determined."""
    try:
        import fcntl
    except ImportError:
        return False
    try:
        handle = file.open("rb+")
    except OSError:  # not writable: using it will report that
        return False
    with handle:
        try:
            fcntl.lockf(handle, fcntl.LOCK_EX | fcntl.LOCK_NB, _SHARED_SIZE, _SHARED_FIRST)
        except (BlockingIOError, PermissionError):  # either, for a taken lock
            return True
        except OSError:  # a file system without locks
            return False
    return False


def damage_of(file: Path, *, every_row: bool = False) -> str | None:
    """Return a short description of the file's damage, or None if it can be used.

    A leftover log, even with a torn end, is the normal result of a power failure and not damage.
    Rows are read if the file is small, or if `every_row` is set. Raises NotDurable if the file
    cannot be read, so that its state is unknown.
    """
    with _unless_hindered(file):
        start = _beginning(file)
        found = _header_damage(start)
        if found is not None:
            return found
        log = log_of(file)
        unclean = log.is_file() and log.stat().st_size > 0
        size = file.stat().st_size
        if not unclean and size % _page_size(start):
            return "it was cut off"
        report = inspect_log(log)
        if not report.header_valid:
            return "the beginning of its log is damaged"
        if report.damaged:
            lost = report.commits_after_invalid
            return f"its log is damaged: {lost} stored transactions cannot be read"
        missing = frames_noted(log, index_of(file)) - report.usable
        if missing > 0:
            return f"its log is damaged: {missing} stored pages at its end cannot be read"
        try:
            pages = unclean or size <= ALWAYS_CHECKED_BYTES or every_row
            return _checked(file, pages=pages, rows=every_row or size <= ROWS_READ_BYTES)
        except (sqlite3.Error, UnicodeDecodeError) as error:
            description = _proven_damage(error)
            if description is None:
                raise
            return description
    return None


def foreign_tables(file: Path) -> list[str]:
    """Return the tables of another program's database; empty if it is Reembody's, or new.

    Raises NotDurable if it cannot be read.
    """
    with _unless_hindered(file), closing(_read_only(file)) as connection:
        query = "SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name"
        names = [str(name) for (name,) in connection.execute(query)]
    return [] if VERSION_TABLE in names else names


@contextmanager
def _unless_hindered(file: Path) -> Iterator[None]:
    try:
        yield
    except (OSError, sqlite3.Error, UnicodeDecodeError) as error:
        words = f"the database {file} cannot be read, and was left as it is"
        raise not_durable_error(words, error) from error


def _proven_damage(error: Exception) -> str | None:
    """Return the damage that an error of SQLite proves; None if it proves none.

    Only a few simple queries are made, so SQLite's failure to understand them (SQLITE_ERROR: an
    unknown file format, a definition that is not valid SQL) is damage as well.
    """
    if isinstance(error, UnicodeDecodeError):
        return UNREADABLE
    if getattr(error, "sqlite_errorcode", None) in (sqlite3.SQLITE_ERROR, sqlite3.SQLITE_TOOBIG):
        return _plain(str(error))
    if not proves_damage(error):
        return None
    return UNREADABLE if "decode" in str(error) else _plain(str(error))


def _plain(description: str) -> str:
    """Return a message as one line, without unprintable characters that come from damaged data."""
    return "".join(letter if letter.isprintable() else "?" for letter in description)[:200]


def _beginning(file: Path) -> bytes:
    with file.open("rb") as handle:
        return handle.read(_HEADER)


def _header_damage(start: bytes) -> str | None:
    if not start.startswith(MAGIC):
        return "it is not a SQLite database" if start else "it is empty (0 bytes)"
    if len(start) < _HEADER:
        return "it was cut off"
    numbers = [int.from_bytes(start[at : at + 4], "big") for at in (44, 56)]
    # https://www.sqlite.org/fileformat2.html, 1.3: values that SQLite never writes but accepts.
    fits = (
        _page_size(start).bit_count() == 1
        and start[18] in (1, 2)
        and start[19] in (1, 2)
        and start[21:24] == bytes((64, 32, 32))
        and numbers[0] in range(5)
        and numbers[1] in range(4)
    )
    return None if fits else "its header is damaged"


def _page_size(header: bytes) -> int:
    size = int.from_bytes(header[16:18], "big")
    return 65536 if size == 1 else max(size, 512)


def _checked(file: Path, *, pages: bool, rows: bool) -> str | None:
    if pages:
        _read_through(file)
    with closing(_read_only(file)) as connection:
        # Messages of SQLite may include damaged bytes.
        connection.text_factory = _as_readable
        # Reading the tables' definitions fails if the file is not a database at all.
        connection.execute("SELECT count(*) FROM sqlite_master").fetchone()
        if not pages:
            return None
        (first,) = connection.execute("PRAGMA quick_check(1)").fetchone()
        if first != "ok":
            _require_read(file, str(first))
            return _plain(str(first))
        connection.text_factory = str
        return _wrong_content(connection) if rows else None


def _require_read(file: Path, finding: str) -> None:
    """Raise OSError if a finding of SQLite shows a read error of the disk instead of damage."""
    code = _ERROR_CODE.search(finding)
    if code is not None and int(code[1]) & 0xFF == sqlite3.SQLITE_IOERR:
        raise OSError(errno.EIO, os.strerror(errno.EIO), str(file))


def _as_readable(text: bytes) -> str:
    return text.decode("utf-8", "replace")


def _wrong_content(connection: sqlite3.Connection) -> str | None:
    """Describe content that this program cannot have written, if the database is Reembody's."""
    found = columns_in(connection)
    if VERSION_TABLE not in found:
        # Another program's, or new; but with many Reembody tables, the version table was lost.
        ours = {shape.name for shape in shapes_at(newest_revision())}
        return UNNAMED if len(ours & found.keys()) > len(ours) / 4 else None
    names = [one for (one,) in connection.execute(f"SELECT version_num FROM {VERSION_TABLE}")]  # noqa: S608 - our own table
    if len(names) != 1 or not isinstance(names[0], str) or not _REVISION.fullmatch(names[0]):
        return UNNAMED
    if names[0] not in all_revisions():
        return UNNAMED if names[0] < newest_revision() else None  # a newer program's
    shapes = shapes_at(names[0])
    wrong = wrong_tables(found, shapes) or _too_new(found, shapes)
    return wrong[0] if wrong else next(wrong_rows(connection, shapes), None)


def _too_new(found: Mapping[str, set[str]], shapes: Iterable[TableShape]) -> list[str]:
    """Return tables and columns that only later schemas have; a migration would clash with them."""
    columns_by_table = {shape.name: {one.name for one in shape.columns} for shape in shapes}
    return [
        f"it has {shape.name}.{column.name} of a later schema than it names"
        for shape in shapes_at(newest_revision())
        for column in shape.columns
        if column.name in found.get(shape.name, ())
        and column.name not in columns_by_table.get(shape.name, ())
    ]


def _read_through(file: Path) -> None:
    """Read the file sequentially into the cache, since SQLite's check reads at random places."""
    with suppress(OSError):  # the check itself will report read errors
        handle = os.open(file, os.O_RDONLY)
        try:
            while os.read(handle, _BLOCK):
                pass
        finally:
            os.close(handle)


def _read_only(file: Path) -> sqlite3.Connection:
    # A read-only connection does not remove the log when it closes.
    return sqlite3.connect(f"{file.absolute().as_uri()}?mode=ro", uri=True, timeout=BUSY_TIMEOUT_S)
