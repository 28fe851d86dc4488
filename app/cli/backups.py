"""Backing up and restoring from the command line, whether or not the server runs."""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType

from sqlalchemy.exc import DBAPIError

from app.cli.errors import warn
from app.clock import Clock
from app.database import Database
from app.errors import NotDurable, ReembodyError
from app.features.care.backups import BackedUp, Restored, back_up, checked_backup, restore
from app.features.care.opening import bring_up_to_date, existing_database, put_away_if_damaged
from app.features.care.rights import ErasuresKept, finish_erasures
from app.features.people.audit import COMMAND_LINE, record_copy
from app.features.record.erasure import expect_erasure, forget_erasure
from app.platform.context import AppContext
from app.platform.folders import backups_of
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
        warn(
            f"the backup is whole, but could not be put on record ({error.orig}): "
            "keep its place in mind when a participant's data are erased"
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
        + ("" if done.audit_head is None else f"\naudit head {done.audit_head}")
    )


def restore_from(path: Path, *, replace: bool, even_though_active: bool, as_json: bool) -> str:
    """Put a backup in the place of what is there; raises ReembodyError with nothing changed.

    Phases whose clock ran when the backup was made are paused afterwards, as after a crash.
    """
    from app.main import create_app  # a backup needs no application

    settings, clock = Settings(), Clock()
    kept = backups_of(settings)
    with (
        told_plainly(),
        Counter("restoring") as counter,
        checked_backup(path, kept, counter) as backup,
    ):
        put_away_if_damaged(settings, clock)
        bring_up_to_date(settings, clock)
        # Complete, but not started: what is done to sessions needs its parts.
        context: AppContext = create_app(settings, clock=clock).state.context
        expected = expect_erasure(settings)
        done = restore(
            context.database,
            backup,
            keep_in=kept,
            clock=clock,
            replace=replace,
            even_though_active=even_though_active,
            erasures=ErasuresKept(context),
            progress=counter,
        )
    if expected and not done.erasures_reapplied:
        forget_erasure(settings)
    _overwrite(context)
    _stop_clocks(context)
    return as_text(done) if as_json else _sentences(done)


def _overwrite(context: AppContext) -> None:
    """What was erased again was in the file for a moment; the next start does the same."""
    try:
        finish_erasures(context)
    except (DBAPIError, ReembodyError) as error:
        warn(
            f"restored, but erased rows are still to be overwritten ({error}): "
            "start the server again"
        )


def _stop_clocks(context: AppContext) -> None:
    """Nobody wears the headsets of those phases now; the next start of a server does the same."""
    from app.features.record.telemetry import stop_running_clocks  # nor any session

    try:
        stop_running_clocks(context)
    except DBAPIError as error:
        warn(
            f"restored, but running phases could not be paused ({error.orig}): "
            "start the server again"
        )
    finally:
        context.database.close()


def _sentences(done: Restored) -> str:
    made = f"{done.made_at:%Y-%m-%d %H:%M:%S} UTC"
    lines = [
        f"Restored {done.rows} rows from {done.path}, made {made}, in {done.duration_s:.1f} s",
        f"sha256 {done.sha256}",
    ]
    if done.before is not None:
        lines.append(f"What was there before: {done.before}")
    if done.erasures_reapplied:
        lines.append(
            f"{done.erasures_reapplied} participant(s) in it had been erased since, and were "
            "erased again"
        )
    if done.unpaired:
        lines.append(f"{done.unpaired} headset(s) of sessions that are not over: pair them again")
    return "\n".join(lines)
