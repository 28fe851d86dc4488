"""Backing up and restoring from the command line, whether or not the server runs."""

import json
import sqlite3
import sys
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from datetime import timedelta
from pathlib import Path

from sqlalchemy.exc import DBAPIError

from app.cli.errors import warn
from app.cli.progress import Activity
from app.clock import Clock
from app.database import Database
from app.errors import ReembodyError
from app.features.care.backups import (
    BackedUp,
    Backup,
    Lifetimes,
    Restored,
    RestoredContent,
    back_up,
    checked_backup,
    holds_people,
    restore,
)
from app.features.care.opening import (
    Damaged,
    begun_if_missing,
    existing_database,
    put_away_if_damaged,
)
from app.features.care.ownership import own_data
from app.features.care.rights import (
    ErasureReplay,
    Tombstone,
    finish_erasures,
    knows_erasures,
    read_list,
    tombstone_file,
)
from app.features.people.audit import COMMAND_LINE, record_copy
from app.features.record.erasure import expect_erasure, forget_erasure
from app.platform.context import AppContext
from app.platform.folders import backups_of, home_of
from app.platform.half_made import Notes
from app.platform.trouble import plainly
from app.schema_revisions import newest_revision
from app.settings import Settings, read_settings


def back_up_to(to: Path, activity: Activity, *, as_json: bool) -> str:
    """Write the backup and say what is in it; raises ReembodyError with nothing left of the file.

    `activity` says which table it is at.
    """
    settings = read_settings()
    with told_plainly():
        database = existing_database(settings)
        notes = Notes.of(settings)
        try:
            progress = activity.rows("backing up")
            done = back_up(database, to, clock=Clock(), notes=notes, progress=progress)
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
    except (DBAPIError, sqlite3.Error) as error:
        warn(
            f"the backup is whole, but could not be put on record ({getattr(error, 'orig', error)})"
            ": keep its place in mind when a participant's data are erased"
        )


def told_plainly() -> AbstractContextManager[None]:
    """Turn what a database or a disk says into NotDurable, which has a remedy."""
    return plainly("nothing was changed, because the database or the disk did not take part")


def as_text(done: object) -> str:
    """A summary as JSON."""
    return json.dumps(vars(done), default=str, indent=2)


def _sentence(done: BackedUp) -> str:
    size_mb = done.size_bytes / 1e6
    return (
        f"{done.path}: {done.rows} rows, {size_mb:.1f} MB in {done.duration_s:.1f} s "
        f"({size_mb / done.duration_s:.0f} MB/s)\n"
        f"sha256 of the content {done.sha256}"
        + ("" if done.audit_head is None else f"\naudit head {done.audit_head}")
    )


def restore_from(
    path: Path,
    activity: Activity,
    *,
    replace: bool,
    even_though_active: bool,
    even_though_altered: bool,
    erasures: Path | None,
    as_json: bool,
) -> str:
    """Put a backup in the place of what is there; raises ReembodyError with nothing changed.

    Phases whose clock ran when the backup was made are paused afterwards, as after a crash. A
    damaged database is put into quarantine first. `erasures` is the list of an earlier data folder,
    whose erasures are made here, too; where there is no list at all it is asked for on a terminal,
    and elsewhere standard error says what that may mean. Nobody else may work with the data from
    the first look at them until all of that is done.
    """
    settings = read_settings()
    with own_data(settings, "restore"), told_plainly():
        return _restored(
            path,
            settings,
            activity,
            replace=replace,
            even_though_active=even_though_active,
            even_though_altered=even_though_altered,
            erasures=erasures,
            as_json=as_json,
        )


def _restored(
    path: Path,
    settings: Settings,
    activity: Activity,
    *,
    replace: bool,
    even_though_active: bool,
    even_though_altered: bool,
    erasures: Path | None,
    as_json: bool,
) -> str:
    from app.main import create_app  # a backup needs no application

    clock, kept = Clock(), backups_of(settings)
    lifetimes = Lifetimes(
        clock.utc_now(),
        login=timedelta(hours=settings.login_hours),
        pairing=timedelta(minutes=settings.pairing_minutes),
    )
    with (
        _no_folder_left(kept),
        checked_backup(path, kept, activity.rows(f"checking {path}")) as backup,
    ):
        activity.now("looking at the database that is there")
        try:
            put_away_if_damaged(settings, clock, every_row=True)
        except Damaged as error:
            warn(error.message)
        with begun_if_missing(settings, clock):
            # Complete, but not started: what is done to sessions needs its parts.
            context: AppContext = create_app(settings, clock=clock).state.context
            with _undone_if_refused(context) as expected:
                outliving = ErasureReplay(
                    context, _earlier_erasures(context, backup, erasures, activity)
                )
                done = restore(
                    context.database,
                    backup,
                    keep_in=kept,
                    clock=clock,
                    replace=replace,
                    even_though_active=even_though_active,
                    erasures=outliving,
                    content=RestoredContent(even_though_altered, lifetimes),
                    progress=activity.rows("restoring"),
                )
    if expected and not done.erasures_reapplied:
        forget_erasure(settings)
    activity.now("overwriting what had been erased")
    _overwrite(context, outliving.given)
    _stop_clocks(context)
    return as_text(done) if as_json else _sentences(done)


@contextmanager
def _no_folder_left(kept: Path) -> Iterator[None]:
    """Folders that were not there before are not there after a restore that failed."""
    missing = [folder for folder in (kept, *kept.parents) if not folder.exists()]
    try:
        yield
    except BaseException:
        for folder in missing:
            with suppress(OSError):
                folder.rmdir()
        raise


@contextmanager
def _undone_if_refused(context: AppContext) -> Iterator[bool]:
    """Leave neither a connection nor the mark of an erasure behind a restore that failed.

    Yields whether the mark was made for this restore.
    """
    expected = expect_erasure(context.settings)
    try:
        yield expected
    except BaseException:
        context.database.close()
        if expected:
            forget_erasure(context.settings)
        raise


def _earlier_erasures(
    context: AppContext, backup: Backup, given: Path | None, activity: Activity
) -> tuple[Tombstone, ...]:
    """The erasures of a list that was given, or named on the terminal; raises ReembodyError."""
    if given is not None:
        return read_list(given)
    if knows_erasures(context) or not holds_people(backup):
        return ()
    made = f"{backup.manifest.made_at:%Y-%m-%d %H:%M} UTC"
    home = home_of(context.settings)
    if sys.stdin.isatty() and sys.stderr.isatty():
        with activity.silent():
            sys.stderr.write(
                f"{home} has no list of erasures. Whoever was erased after the backup was made "
                f"({made}) comes back with it.\nFile erasures.jsonl of the earlier data folder "
                "(Enter if nobody was erased since): "
            )
            sys.stderr.flush()
            named = sys.stdin.readline().strip()
        return read_list(Path(named)) if named else ()
    warn(
        f"{home} has no list of erasures: participants who were erased after the backup was made "
        f"({made}) are back. If there are any, restore again with --replace --erasures FILE, the "
        "erasures.jsonl of the earlier data folder; or copy it here, and the next start of the "
        "server erases them"
    )
    return ()


def _overwrite(context: AppContext, given: Sequence[Tombstone]) -> None:
    """What was erased again was in the file for a moment; the next start does the same."""
    try:
        tombstone_file(context.settings).add(given)
        finish_erasures(context)
    except (DBAPIError, sqlite3.Error, ReembodyError, OSError) as error:
        warn(
            f"restored, but erased rows are still to be overwritten ({error}): "
            "start the server again"
        )


def _stop_clocks(context: AppContext) -> None:
    """Nobody wears the headsets of those phases now; the next start of a server does the same."""
    from app.features.record.telemetry import stop_running_clocks  # nor any session

    try:
        stop_running_clocks(context)
    except (DBAPIError, sqlite3.Error) as error:
        warn(
            f"restored, but running phases could not be paused ({getattr(error, 'orig', error)}): "
            "start the server again"
        )
    finally:
        context.database.close()


def _sentences(done: Restored) -> str:
    made = f"{done.made_at:%Y-%m-%d %H:%M:%S} UTC"
    lines = [
        f"Restored {done.rows} rows from {done.path}, made {made}, in {done.duration_s:.1f} s",
        f"sha256 of the content {done.sha256}",
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
