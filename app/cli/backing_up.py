"""Backing up and restoring from the command line, whether or not the server runs."""

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from sqlalchemy.exc import DBAPIError

from app.clock import Clock
from app.errors import NotDurable
from app.features.backups.service import BackedUp, Restored, back_up, checked_backup, restore
from app.features.context import AppContext
from app.features.opening.service import (
    backups_of,
    bring_up_to_date,
    existing_database,
    put_away_if_damaged,
)
from app.features.sessions.recovery import stop_running_clocks
from app.main import create_app
from app.settings import Settings


def back_up_to(to: Path, *, as_json: bool) -> str:
    """Write the backup and say what is in it; raises ReembodyError with nothing left of the file.

    Progress goes to standard error.
    """
    with _told_plainly():
        database = existing_database(Settings())
        try:
            with Counter("backing up") as counter:
                done = back_up(database, to, clock=Clock(), progress=counter)
        finally:
            database.close()
    return _as_json(done) if as_json else _backed_up(done)


def restore_from(path: Path, *, replace: bool, even_though_active: bool, as_json: bool) -> str:
    """Put a backup in the place of what is there; raises ReembodyError with nothing changed.

    Phases whose clock ran when the backup was made are paused afterwards, as after a crash.
    """
    settings, clock = Settings(), Clock()
    kept = backups_of(settings)
    with (
        _told_plainly(),
        Counter("restoring") as counter,
        checked_backup(path, kept, counter) as backup,
    ):
        put_away_if_damaged(settings, clock)
        bring_up_to_date(settings, clock)
        # Complete, but not started: what is done to sessions needs its parts.
        context: AppContext = create_app(settings, clock=clock).state.context
        done = restore(
            context.database,
            backup,
            keep_in=kept,
            clock=clock,
            replace=replace,
            even_though_active=even_though_active,
            progress=counter,
        )
    _stop_clocks(context)
    return _as_json(done) if as_json else _restored(done)


def _stop_clocks(context: AppContext) -> None:
    """Nobody wears the headsets of those phases now; the next start of a server does the same."""
    try:
        stop_running_clocks(context)
    except DBAPIError as error:
        print(
            f"reembody: restored, but running phases could not be paused ({error.orig}): "
            "start the server again",
            file=sys.stderr,
        )
    finally:
        context.database.close()


@contextmanager
def _told_plainly() -> Iterator[None]:
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
    _table: str = field(default="")

    def __call__(self, table: str, rows: int) -> None:
        """Some more rows of a table are done."""
        self._rows = self._rows + rows if table == self._table else rows
        self._table = table
        if sys.stderr.isatty():
            sys.stderr.write(f"\r\033[K{self.what}: {table}, {self._rows} rows")
            sys.stderr.flush()

    def __enter__(self) -> "Counter":
        return self

    def __exit__(self, *_: object) -> None:
        if sys.stderr.isatty():
            sys.stderr.write("\r\033[K")


def _backed_up(done: BackedUp) -> str:
    size_mb = done.size_bytes / 1e6
    return (
        f"{done.path}: {done.rows} rows, {size_mb:.1f} MB in {done.duration_s:.1f} s "
        f"({size_mb / done.duration_s:.0f} MB/s)\n"
        f"sha256 {done.sha256}"
    )


def _restored(done: Restored) -> str:
    made = f"{done.made_at:%Y-%m-%d %H:%M:%S} UTC"
    lines = [
        f"Restored {done.rows} rows from {done.path}, made {made}, in {done.duration_s:.1f} s",
        f"sha256 {done.sha256}",
    ]
    if done.before is not None:
        lines.append(f"What was there before: {done.before}")
    if done.unpaired:
        lines.append(f"{done.unpaired} headset(s) of sessions that are not over: pair them again")
    return "\n".join(lines)


def _as_json(done: BackedUp | Restored) -> str:
    return json.dumps(vars(done), default=str, indent=2)
