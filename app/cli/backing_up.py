"""Backing up from the command line, whether or not the server runs."""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

from sqlalchemy.exc import DBAPIError

from app.clock import Clock
from app.database import Database
from app.errors import NotDurable
from app.features.care.backups.service import BackedUp, back_up
from app.features.care.opening.service import existing_database
from app.features.people.audit.copies import COMMAND_LINE, record_copy
from app.schema_revisions import newest_revision
from app.settings import Settings


def back_up_to(to: Path, *, as_json: bool) -> str:
    """Write the backup and say what is in it; raises ReembodyError with nothing left of the file.

    Progress goes to standard error.
    """
    with told_plainly():
        database = existing_database(Settings())
        try:
            with Counter("backing up") as counter:
                done = back_up(database, to, clock=Clock(), progress=counter)
            _put_on_record(database, done)
        finally:
            database.close()
    return as_text(done) if as_json else _sentence(done)


def _put_on_record(database: Database, done: BackedUp) -> None:
    """A copy left the database; a backup is whole even where that cannot be written down."""
    if done.revision != newest_revision():
        return
    try:
        with database.writing() as db:
            record_copy(
                db,
                kind="backup",
                place=str(done.path.absolute()),
                by=COMMAND_LINE,
                now=done.made_at,
                size_bytes=done.size_bytes,
            )
    except DBAPIError as error:
        print(
            f"reembody: the backup is whole, but could not be put on record ({error.orig}): "
            "keep its place in mind when a participant's data are erased",
            file=sys.stderr,
        )


@contextmanager
def told_plainly() -> Iterator[None]:
    """Turn what a database says into NotDurable, which has a remedy."""
    try:
        yield
    except DBAPIError as error:
        raise NotDurable(
            f"the database did not take part: {error.orig}; nothing was changed",
            remedy="See whether it runs and is whole, then try again.",
        ) from error


@dataclass
class Counter:
    """Counts rows on standard error while somebody watches."""

    what: str
    _rows: int = 0
    _table: str = ""

    def __call__(self, table: str, rows: int) -> None:
        """Some more rows of a table are done."""
        self._rows = self._rows + rows if table == self._table else rows
        self._table = table
        if sys.stderr.isatty():
            sys.stderr.write(f"\r\033[K{self.what}: {table}, {self._rows} rows")
            sys.stderr.flush()

    def __enter__(self) -> "Counter":
        return self

    def __exit__(
        self,
        _type: type[BaseException] | None,
        _error: BaseException | None,
        _traceback: TracebackType | None,
    ) -> None:
        if sys.stderr.isatty():
            sys.stderr.write("\r\033[K")


def as_text(done: object) -> str:
    """A summary as JSON."""
    return json.dumps(vars(done), default=str, indent=2)


def _sentence(done: BackedUp) -> str:
    size_mb = done.size_bytes / 1e6
    return (
        f"{done.path}: {done.rows} rows, {size_mb:.1f} MB in {done.duration_s:.1f} s "
        f"({size_mb / done.duration_s:.0f} MB/s)\n"
        f"sha256 {done.sha256}"
    )
