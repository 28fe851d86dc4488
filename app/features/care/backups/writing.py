"""Write a backup to a temporary file, check it, and rename it to its final name.

Other processes see either no file or a complete one. Rows are read inside the transaction of the
caller, which must be a snapshot of one moment.
"""

import os
import shutil
import sqlite3
import tempfile
from collections.abc import Iterator
from contextlib import closing, contextmanager
from datetime import datetime
from pathlib import Path

from sqlalchemy import Connection

from app import __version__
from app.errors import Conflict, InvalidInput, NotDurable, NotFound, file_problem
from app.features.care.backups.digest import Digester, TableDigest
from app.features.care.backups.manifest import Manifest, write_manifest
from app.features.care.backups.reading import opened_backup, opened_copy
from app.features.care.backups.rows import Progress, read_rows, silent, sqlite_insert
from app.features.care.backups.shapes import TableShape, shapes_of, shapes_of_models
from app.platform.incomplete_files import Notes, partial_folder
from app.schema_revisions import all_revisions, make_file, newest_revision, revision_of

SPARE_BYTES = 64 * 1024 * 1024
"""Space that a backup leaves free on its disk, which the server may write to as well."""
_FOR_ONE_WRITER = ("journal_mode=DELETE", "journal_mode=OFF", "synchronous=OFF")


def write_backup(
    source: Connection,
    to: Path,
    *,
    now: datetime,
    notes: Notes | None = None,
    progress: Progress = silent,
) -> Manifest:
    """Copy everything that `source` sees to the file `to`, readable by its owner only.

    `notes` record the temporary file while it is written, if it is outside of the data folder.
    Raises Conflict if the file exists already, NotFound if the folder or a Reembody database is
    missing, NotDurable if the file cannot be written. Then nothing is left of it.
    """
    check_place(to)
    revision = _require_known(revision_of(source))
    _require_space(source, to)
    with _raising_not_durable(to), _temporary_file(to, now, notes) as partial:
        _make_tables(partial, revision)
        _fill(source, partial, revision, now, progress)
        with opened_backup(partial) as made:
            _move(partial, to)
            return made.manifest


def check_place(to: Path) -> None:
    """Raise Conflict if the file `to` exists, NotFound if its folder does not."""
    if to.exists() or to.is_symlink():
        raise Conflict(
            f"there is a file {to} already; nothing was written",
            value=str(to),
            valid="the name of a new file",
            remedy="Name another file: a backup never replaces an earlier one.",
        )
    if not to.absolute().parent.is_dir():
        raise NotFound(
            f"there is no folder {to.absolute().parent}; nothing was written",
            value=str(to),
            remedy="Create the folder, or connect the disk that it is on.",
        )


def _require_known(revision: str | None) -> str:
    if revision is None:
        raise NotFound(
            "there is no Reembody database here",
            remedy="Set REEMBODY_DATA_DIR or REEMBODY_DATABASE_URL as for the server.",
        )
    if revision not in all_revisions():
        raise Conflict(
            f"the database has the schema {revision}, which this program does not know",
            value=revision,
            valid=list(all_revisions()),
            remedy="Back it up with the newer program that last used it.",
        )
    return revision


def _require_space(source: Connection, to: Path) -> None:
    if source.dialect.name == "sqlite":
        needed = _pragma(source, "page_size") * (
            _pragma(source, "page_count") - _pragma(source, "freelist_count")
        )
    else:
        size = source.exec_driver_sql("SELECT pg_database_size(current_database())")
        needed = int(size.scalar_one())
    free = shutil.disk_usage(to.absolute().parent).free
    if free < needed + SPARE_BYTES:
        raise NotDurable(
            f"{to} may need {_mb(needed)}, and its disk has {_mb(free)} left; nothing was written",
            value=free,
            valid=needed + SPARE_BYTES,
            remedy="Free some space there, or name a file on another disk.",
        )


def _pragma(source: Connection, name: str) -> int:
    return int(source.exec_driver_sql(f"PRAGMA {name}").scalar_one())


def _mb(size: int) -> str:
    return f"{size / 1e6:.0f} MB"


@contextmanager
def _temporary_file(to: Path, now: datetime, notes: Notes | None) -> Iterator[Path]:
    """Yield a file in a private temporary folder next to `to`, which is removed afterwards."""
    with partial_folder("backup", to, now=now, notes=notes) as folder:
        yield folder / to.name


@contextmanager
def _raising_not_durable(to: Path) -> Iterator[None]:
    try:
        yield
    except (sqlite3.Error, OSError, InvalidInput) as error:
        raise NotDurable(
            f"{to} could not be written: {_why(error)}; nothing is left of it",
            value=str(to),
            remedy="Free some space there, or name a file on another disk.",
        ) from error


def _why(error: Exception) -> str:
    return file_problem(error) if isinstance(error, OSError) else str(error)


def _make_tables(file: Path, revision: str) -> None:
    """Create the product's tables in a new file, in the schema of the database that is copied."""
    try:
        make_file(file, revision)
    except sqlite3.Error as error:
        raise OSError(str(error)) from error


def shapes_at(revision: str) -> tuple[TableShape, ...]:
    """Return the product's tables in the schema of a revision, referenced ones first."""
    if revision == newest_revision():
        return shapes_of_models()
    with tempfile.TemporaryDirectory(prefix="reembody-schema-") as folder:
        empty = Path(folder) / "empty.sqlite"
        _make_tables(empty, revision)
        with opened_copy(empty) as connection:
            return shapes_of(connection)


def _fill(source: Connection, file: Path, revision: str, now: datetime, progress: Progress) -> None:
    with opened_copy(file) as empty:
        shapes = shapes_of(empty)
    with closing(sqlite3.connect(file, isolation_level=None)) as target:
        for pragma in _FOR_ONE_WRITER:
            target.execute(f"PRAGMA {pragma}")
        target.execute("BEGIN")
        tables = {shape.name: _copy(source, shape, target, progress) for shape in shapes}
        manifest = Manifest(now, __version__, revision, source.dialect.name, tables)
        write_manifest(target, manifest)
        target.execute("COMMIT")


def _copy(
    source: Connection, shape: TableShape, target: sqlite3.Connection, progress: Progress
) -> TableDigest:
    statement, digester = sqlite_insert(shape), Digester(shape)
    for rows in read_rows(source, shape):
        target.executemany(statement, rows)
        digester.add(rows)
        progress(shape.name, len(rows))
    return digester.digest


def _move(partial: Path, to: Path) -> None:
    """Flush the file to the disk, rename it, and flush its folder.

    If that fails, the file is deleted, because the caller reports that there is no backup.
    """
    with partial.open("rb+") as file:
        os.fsync(file.fileno())
    partial.chmod(0o600)
    check_place(to)
    partial.rename(to)
    try:
        folder = os.open(to.absolute().parent, os.O_RDONLY)
        try:
            os.fsync(folder)
        finally:
            os.close(folder)
    except OSError:
        to.unlink(missing_ok=True)
        raise
