"""Back up and restore from the command line, whether or not the server runs."""

import json
import sqlite3
import sys
from collections.abc import Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager, suppress
from dataclasses import dataclass
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
    created_if_missing,
    existing_database,
    quarantine_if_damaged,
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
from app.features.record.erasure import clear_erasure_mark, mark_erasure
from app.platform.context import AppContext
from app.platform.folders import backups_of, home_of
from app.platform.incomplete_files import Notes
from app.platform.trouble import errors_as_not_durable
from app.schema_revisions import newest_revision
from app.settings import Settings, read_settings


def back_up_to(to: Path, activity: Activity, *, as_json: bool) -> str:
    """Write a backup and return its summary; raise ReembodyError, leaving no file, if that fails.

    `activity` reports the table that is being copied.
    """
    settings = read_settings()
    with storage_errors_reported():
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
    """Record that a copy left the database; if that fails, warn, since the backup is complete."""
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
            f"the backup is complete but could not be recorded ({getattr(error, 'orig', error)}):"
            " remember where it is when a participant's data are erased"
        )


def storage_errors_reported() -> AbstractContextManager[None]:
    """Convert errors of the database or the disk to NotDurable, which has a remedy."""
    return errors_as_not_durable(
        "nothing was changed, because the database or the disk reported an error"
    )


def as_text(done: object) -> str:
    """Return a summary as JSON."""
    return json.dumps(vars(done), default=str, indent=2)


def _sentence(done: BackedUp) -> str:
    size_mb = done.size_bytes / 1e6
    return (
        f"{done.path}: {done.rows} rows, {size_mb:.1f} MB in {done.duration_s:.1f} s "
        f"({size_mb / done.duration_s:.0f} MB/s)\n"
        f"sha256 of the content {done.sha256}"
        + ("" if done.audit_head is None else f"\naudit head {done.audit_head}")
    )


@dataclass(frozen=True, kw_only=True)
class RestoreOptions:
    """The options of `reembody restore`, as on its command line.

    `replace`: replace a database that contains data. `even_though_active`, `even_though_altered`:
    restore although sessions are running, or although the backup was altered. `erasures`: the list
    of erasures of an earlier data folder, or None.
    """

    replace: bool
    even_though_active: bool
    even_though_altered: bool
    erasures: Path | None


def restore_from(path: Path, activity: Activity, options: RestoreOptions, *, as_json: bool) -> str:
    """Replace the database by a backup; raise ReembodyError with nothing changed if that fails.

    Phases whose clock was running when the backup was made are paused afterwards, as after a crash.
    A damaged database is quarantined first. The erasures listed in `options.erasures` are repeated
    here; if there is no list at all, the user is asked for it on a terminal, and elsewhere a
    warning on standard error says what its absence may mean. The data are locked against other
    processes from the first check until everything is done.
    """
    settings = read_settings()
    with own_data(settings, "restore"), storage_errors_reported():
        done = _restored(path, settings, activity, options)
        return as_text(done) if as_json else _sentences(done)


def _restored(
    path: Path, settings: Settings, activity: Activity, options: RestoreOptions
) -> Restored:
    from app.main import create_app  # not needed to back up

    clock, backups_folder = Clock(), backups_of(settings)
    lifetimes = Lifetimes(
        clock.utc_now(),
        login=timedelta(hours=settings.login_hours),
        pairing=timedelta(minutes=settings.pairing_minutes),
    )
    with (
        _no_folder_left(backups_folder),
        checked_backup(path, backups_folder, activity.rows(f"checking {path}")) as backup,
    ):
        activity.now("checking the existing database")
        try:
            quarantine_if_damaged(settings, clock, every_row=True)
        except Damaged as error:
            warn(error.message)
        with created_if_missing(settings, clock):
            # The application is not started, but changing sessions needs its parts.
            context: AppContext = create_app(settings, clock=clock).state.context
            with _undone_if_refused(context) as expected:
                outliving = ErasureReplay(
                    context, _earlier_erasures(context, backup, options.erasures, activity)
                )
                done = restore(
                    context.database,
                    backup,
                    keep_in=backups_folder,
                    clock=clock,
                    replace=options.replace,
                    even_though_active=options.even_though_active,
                    erasures=outliving,
                    content=RestoredContent(options.even_though_altered, lifetimes),
                    progress=activity.rows("restoring"),
                )
    if expected and not done.erasures_reapplied:
        clear_erasure_mark(settings)
    activity.now("overwriting what had been erased")
    _overwrite(context, outliving.given)
    _stop_clocks(context)
    return done


@contextmanager
def _no_folder_left(backups_folder: Path) -> Iterator[None]:
    """Remove the folders that a failed restore has created."""
    missing = [
        folder for folder in (backups_folder, *backups_folder.parents) if not folder.exists()
    ]
    try:
        yield
    except BaseException:
        for folder in missing:
            with suppress(OSError):
                folder.rmdir()
        raise


@contextmanager
def _undone_if_refused(context: AppContext) -> Iterator[bool]:
    """Close the database and remove the mark of a pending erasure if the restore fails.

    Yields whether the mark was made for this restore.
    """
    expected = mark_erasure(context.settings)
    try:
        yield expected
    except BaseException:
        context.database.close()
        if expected:
            clear_erasure_mark(context.settings)
        raise


def _earlier_erasures(
    context: AppContext, backup: Backup, given: Path | None, activity: Activity
) -> tuple[Tombstone, ...]:
    """Return the erasures of the list given as an option or on the terminal.

    Raises ReembodyError if the list cannot be read.
    """
    if given is not None:
        return read_list(given)
    if knows_erasures(context) or not holds_people(backup):
        return ()
    made = f"{backup.manifest.made_at:%Y-%m-%d %H:%M} UTC"
    home = home_of(context.settings)
    if sys.stdin.isatty() and sys.stderr.isatty():
        with activity.silent():
            sys.stderr.write(
                f"{home} has no list of erasures. Participants erased after the backup was made "
                f"({made}) are restored with it.\nFile erasures.jsonl of the earlier data folder "
                "(Enter if nobody was erased since): "
            )
            sys.stderr.flush()
            entered = sys.stdin.readline().strip()
        return read_list(Path(entered)) if entered else ()
    warn(
        f"{home} has no list of erasures: participants who were erased after the backup was made "
        f"({made}) are back. If there are any, restore again with --replace --erasures FILE, the "
        "erasures.jsonl of the earlier data folder; or copy it here, and the next start of the "
        "server erases them"
    )
    return ()


def _overwrite(context: AppContext, given: Sequence[Tombstone]) -> None:
    """Overwrite the rows that were restored and then erased again.

    If that fails, the next start of the server does it.
    """
    try:
        tombstone_file(context.settings).add(given)
        finish_erasures(context)
    except (DBAPIError, sqlite3.Error, ReembodyError, OSError) as error:
        warn(
            f"restored, but erased rows could not yet be overwritten ({error}): "
            "start the server again"
        )


def _stop_clocks(context: AppContext) -> None:
    """Pause the phases that were running when the backup was made: their headsets are off now.

    If that fails, the next start of the server does it.
    """
    from app.features.record.telemetry import stop_running_clocks  # not needed to back up

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
        lines.append(f"The replaced data: {done.before}")
    if done.erasures_reapplied:
        lines.append(
            f"{done.erasures_reapplied} participant(s) in it had been erased since then, and were "
            "erased again"
        )
    if done.unpaired:
        lines.append(f"{done.unpaired} headset(s) of unfinished sessions: pair them again")
    return "\n".join(lines)
