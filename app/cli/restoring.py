"""Restoring from the command line, whether or not the server runs."""

import sys
from pathlib import Path

from sqlalchemy.exc import DBAPIError

from app.cli.backing_up import Counter, as_text, told_plainly
from app.clock import Clock
from app.errors import ReembodyError
from app.features.care.backups.service import Restored, checked_backup, restore
from app.features.care.opening.service import bring_up_to_date, put_away_if_damaged
from app.features.care.rights.service import ErasuresKept, finish_erasures
from app.features.record.erasure import expect_erasure, forget_erasure
from app.features.record.telemetry import stop_running_clocks
from app.main import create_app
from app.platform.context import AppContext
from app.platform.folders import backups_of
from app.settings import Settings


def restore_from(path: Path, *, replace: bool, even_though_active: bool, as_json: bool) -> str:
    """Put a backup in the place of what is there; raises ReembodyError with nothing changed.

    Phases whose clock ran when the backup was made are paused afterwards, as after a crash.
    """
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
        print(
            f"reembody: restored, but erased rows are still to be overwritten ({error}): "
            "start the server again",
            file=sys.stderr,
        )


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
