"""Open a backup without modifying it, and check that it is complete.

A backup of an earlier version is copied, and the copy migrated to the newest schema; the file
itself is never changed.
"""

import shutil
import sqlite3
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sqlalchemy import Connection, StaticPool, create_engine
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from app.errors import InvalidInput, NotDurable, NotFound, missing_file
from app.features.care.backups.content import wrong_rows, wrong_tables
from app.features.care.backups.digest import TableDigest, digest_of
from app.features.care.backups.manifest import Manifest, ManifestError, read_manifest
from app.features.care.backups.readable import unfit_rows
from app.features.care.backups.rows import Progress, silent
from app.features.care.backups.shapes import TableShape, shapes_of, shapes_of_models
from app.platform.trouble import DAMAGED, explain
from app.schema_revisions import all_revisions, migrate_file, newest_revision


@dataclass(frozen=True)
class Backup:
    """A backup that is open for reading, and whose checksums match.

    `path` is the file that was given. `shapes` are its tables, referenced ones first, `tables`
    their checksums, `connection` the connection to read their rows.
    """

    path: Path
    manifest: Manifest
    shapes: tuple[TableShape, ...]
    tables: Mapping[str, TableDigest]
    connection: Connection


@contextmanager
def opened_backup(path: Path, progress: Progress = silent) -> Iterator[Backup]:
    """Open a backup and verify every checksum in it.

    Raises NotFound if there is no file, and InvalidInput if it is damaged, truncated or not a
    Reembody backup. The file is neither changed nor locked.
    """
    if not path.is_file():
        raise NotFound(missing_file(path), value=str(path))
    with closing(sqlite3.connect(_address(path), uri=True, check_same_thread=False)) as driver:
        try:
            manifest = read_manifest(driver)
            _require_length(path)
            with _through_sqlalchemy(driver) as connection:
                shapes = shapes_of(connection)
                tables = digests(connection, shapes, progress)
                _compare(tables, manifest.tables)
        except UNREADABLE as error:
            raise _refused(path, _why(error)) from error
        with _through_sqlalchemy(driver) as connection:
            yield Backup(path, manifest, shapes, tables, connection)


def require_ours(backup: Backup) -> None:
    """Reject a backup that this program cannot have written, whatever its checksums say.

    `backup` is in the newest schema. Raises InvalidInput for missing or additional tables and
    columns, views and triggers, values of a wrong type or range, and rows that refer to missing
    rows.
    """
    driver: Any = backup.connection.connection.driver_connection
    found = {shape.name: [one.name for one in shape.columns] for shape in backup.shapes}
    ours = shapes_of_models()
    try:
        wrong = wrong_tables(found, ours, exactly=True)
        more = "SELECT type || ' ' || name FROM sqlite_master WHERE type IN ('view', 'trigger')"
        wrong += [f"there is a {name}" for (name,) in driver.execute(more)]
        if not wrong:
            wrong += list(wrong_rows(driver, ours))
        if not wrong:
            wrong += list(unfit_rows(driver))
        if not wrong:
            lost = driver.execute("PRAGMA foreign_key_check").fetchall()
            wrong += [f"rows of {row[0]} refer to nothing in {row[2]}" for row in lost[:1]]
    except UNREADABLE as error:
        raise _refused(backup.path, _why(error)) from error
    if wrong:
        raise _refused(backup.path, "; ".join(wrong[:3]))


UNREADABLE = (
    ManifestError,
    SQLAlchemyError,
    sqlite3.Error,
    ValueError,
    TypeError,
    AttributeError,
    LookupError,
    RecursionError,
)
"""The errors that reading an untrusted file can raise."""


def _refused(path: Path, why: str) -> InvalidInput:
    return InvalidInput(
        f"{path} is not a complete Reembody backup: {why}. Nothing was changed",
        value=str(path),
        valid="a file that `./run backup` wrote",
        remedy="Use another copy of this backup, or another backup.",
    )


@contextmanager
def opened_copy(path: Path) -> Iterator[Connection]:
    """Open a SQLite file that no process is writing to, for reading."""
    with (
        closing(sqlite3.connect(_address(path), uri=True, check_same_thread=False)) as driver,
        _through_sqlalchemy(driver) as connection,
    ):
        yield connection


def digests(
    connection: Connection, shapes: tuple[TableShape, ...], progress: Progress = silent
) -> dict[str, TableDigest]:
    """Return the current checksums of all tables."""
    return {shape.name: digest_of(connection, shape, progress) for shape in shapes}


def _address(path: Path) -> str:
    # Immutable: SQLite creates no lock and no other file, so the medium may be read-only.
    return f"{path.absolute().as_uri()}?mode=ro&immutable=1"


def _require_length(path: Path) -> None:
    """Raise ManifestError if the file is truncated; SQLite does not notice a few missing bytes."""
    with path.open("rb") as file:
        start = file.read(32)
    page_size, pages = int.from_bytes(start[16:18], "big"), int.from_bytes(start[28:32], "big")
    expected = (65536 if page_size == 1 else page_size) * pages
    if path.stat().st_size != expected:
        raise ManifestError(f"it has {path.stat().st_size} bytes instead of {expected}")


@contextmanager
def _through_sqlalchemy(driver: sqlite3.Connection) -> Iterator[Connection]:
    engine = create_engine(
        "sqlite://", creator=lambda: driver, poolclass=StaticPool, hide_parameters=True
    )
    with engine.connect() as connection:
        yield connection


def _compare(found: Mapping[str, TableDigest], listed: Mapping[str, TableDigest]) -> None:
    wrong = sorted(
        name for name in found.keys() | listed.keys() if found.get(name) != listed.get(name)
    )
    if wrong:
        raise ManifestError(f"these tables are not what was written: {', '.join(wrong)}")


def _why(error: Exception) -> str:
    return str(getattr(error, "orig", None) or error)


@contextmanager
def as_newest(backup: Backup, workplace: Path) -> Iterator[Backup]:
    """Yield the backup in the newest schema, from a migrated copy in `workplace` if necessary.

    Raises InvalidInput for a backup of a newer program, NotDurable if there is no space.
    """
    revision = backup.manifest.revision
    if revision == newest_revision():
        yield backup
        return
    if revision not in all_revisions():
        raise InvalidInput(
            f"{backup.path} was made by version {backup.manifest.product_version} and has the "
            f"schema {revision}, which this program does not know; nothing was changed",
            value=revision,
            valid=list(all_revisions()),
            remedy=f"Install version {backup.manifest.product_version} or a later one.",
        )
    workplace.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(
        prefix=".restoring-", dir=workplace, ignore_cleanup_errors=True
    ) as folder:
        copy = Path(folder) / "copy.sqlite"
        try:
            shutil.copyfile(backup.path, copy)
            migrate_file(copy)
        except (OSError, sqlite3.Error, DBAPIError, RuntimeError, ValueError) as error:
            if not isinstance(error, OSError) and explain(error) in (None, DAMAGED):
                # The disk is not the cause: the tables are not those of the schema in the manifest.
                raise _refused(backup.path, _why(error)) from error
            raise NotDurable(
                f"{backup.path} could not be brought to the newest schema in {workplace}: "
                f"{_why(error)}; nothing was changed",
                remedy="Free some space there.",
            ) from error
        with opened_copy(copy) as connection:
            shapes = shapes_of(connection)
            tables = digests(connection, shapes)
            yield Backup(backup.path, backup.manifest, shapes, tables, connection)
