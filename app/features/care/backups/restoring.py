"""Replace all rows of a database by those of a backup, in one transaction."""

from collections.abc import Sequence

from sqlalchemy import Connection, column, delete, select, table, text
from sqlalchemy.exc import DBAPIError

from app.errors import InvalidInput, NotDurable
from app.features.care.backups.digest import digest_of
from app.features.care.backups.reading import Backup
from app.features.care.backups.rows import Progress, read_rows, silent, write_rows
from app.features.care.backups.shapes import TableShape

LOCK_TIMEOUT = "30s"


def hold_still(target: Connection, shapes: Sequence[TableShape]) -> None:
    """Block all other writers until this transaction ends; readers continue.

    On SQLite, a writing transaction already does this. Raises NotDurable if another writer does not
    release its lock.
    """
    if target.dialect.name == "sqlite":
        return
    names = ", ".join(target.dialect.identifier_preparer.quote(shape.name) for shape in shapes)
    try:
        target.execute(text(f"SET LOCAL lock_timeout = '{LOCK_TIMEOUT}'"))
        target.execute(text(f"LOCK TABLE {names} IN EXCLUSIVE MODE"))
    except DBAPIError as error:
        raise NotDurable(
            f"another process is writing and did not stop for {LOCK_TIMEOUT}; nothing was changed",
            remedy="Try again, or stop the server first.",
        ) from error


def is_empty(target: Connection, shapes: Sequence[TableShape]) -> bool:
    """Return whether no table has a row."""
    return not any(
        target.execute(select(column(shape.key[0])).select_from(table(shape.name)).limit(1)).first()
        for shape in shapes
    )


def replace_rows(target: Connection, backup: Backup, progress: Progress = silent) -> None:
    """Delete every row, insert the backup's, and verify the checksums of the inserted rows.

    `target` must have the backup's schema. Raises InvalidInput if its content then differs from the
    backup's; the caller's transaction must then be rolled back, as for any other error.
    """
    for shape in reversed(backup.shapes):
        target.execute(delete(table(shape.name)))
    for shape in backup.shapes:
        for rows in read_rows(backup.connection, shape):
            write_rows(target, shape, rows)
            progress(shape.name, len(rows))
        if digest_of(target, shape) != backup.tables[shape.name]:
            raise InvalidInput(
                f"{shape.name} does not match {backup.path}; nothing was changed",
                value=shape.name,
                remedy="Keep the backup, and use another copy of it.",
            )
