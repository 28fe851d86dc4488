"""Backups of earlier versions: a copy is brought to the newest schema, never the file itself."""

import shutil
import sqlite3
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy.exc import DBAPIError

from app.errors import InvalidInput, NotDurable
from app.features.care.backups.reading import Backup, digests, opened_copy
from app.features.care.backups.shapes import shapes_of
from app.schema_revisions import known_revisions, migrate, newest_revision


@contextmanager
def as_newest(backup: Backup, workplace: Path) -> Iterator[Backup]:
    """The same content in the newest schema; a copy is made in the folder `workplace` if need be.

    Raises InvalidInput for a backup of a newer program, NotDurable where there is no room.
    """
    revision = backup.manifest.revision
    if revision == newest_revision():
        yield backup
        return
    if revision not in known_revisions():
        raise InvalidInput(
            f"{backup.path} was made by version {backup.manifest.product_version} and has the "
            f"schema {revision}, which this program does not know; nothing was changed",
            value=revision,
            valid=list(known_revisions()),
            remedy=f"Install version {backup.manifest.product_version} or a later one.",
        )
    workplace.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".restoring-", dir=workplace) as folder:
        copy = Path(folder) / "copy.sqlite"
        try:
            shutil.copyfile(backup.path, copy)
            migrate(f"sqlite:///{copy}")
        except (OSError, sqlite3.Error, DBAPIError) as error:
            raise NotDurable(
                f"{backup.path} could not be brought to the newest schema in {workplace}: "
                f"{error}; nothing was changed",
                remedy="Free some space there.",
            ) from error
        with opened_copy(copy) as connection:
            shapes = shapes_of(connection)
            tables = digests(connection, shapes)
            yield Backup(backup.path, backup.manifest, shapes, tables, connection)
