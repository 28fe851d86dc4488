"""The steps that open the database at every start, before anything uses it."""

import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from sqlalchemy import Connection, func, inspect, make_url, select, table

from app import __version__
from app.clock import Clock
from app.database import Database, open_database
from app.errors import Conflict, NotFound, ReembodyError
from app.features.care.backups import ENDING, back_up, stamped
from app.features.care.opening.inspection import damage_of, foreign_tables, is_open_elsewhere
from app.features.care.opening.quarantine import Quarantine, flush_to_disk
from app.platform.folders import (
    BEGINNING,
    DATABASE_SUFFIXES,
    backups_of,
    database_file,
    home_of,
    is_there,
    require_one_name,
    traces_of_a_database,
)
from app.platform.trouble import errors_as_not_durable, not_durable_error
from app.schema_revisions import (
    all_revisions,
    make_file,
    migrate,
    newest_revision,
    revision_of,
)
from app.settings import Settings


class Damaged(Conflict):
    """The database is damaged and was moved into quarantine."""


def quarantine_if_damaged(settings: Settings, clock: Clock, *, every_row: bool = False) -> None:
    """Inspect the embedded database, and move a damaged one into quarantine, with its log.

    Raises Damaged if that happened, Conflict if the file is another program's, and NotDurable if it
    cannot be read, so that its state is unknown; in the last two cases it is left alone.

    Call it in a process that has not opened the database yet. While another process uses the
    database, it is not inspected: that process did so when it started. `every_row`: read every row
    even of a large file.
    """
    file = database_file(settings)
    if file is None:
        return
    quarantine = Quarantine(file)
    with errors_as_not_durable(
        f"what an earlier start began to move into {quarantine.folder} is not moved yet"
    ):
        quarantine.finish()
    if not is_there(file) or is_open_elsewhere(file):
        return
    damage = damage_of(file, every_row=every_row)
    if damage is not None:
        raise _quarantined(file, damage, settings, clock)
    _refuse_foreign(foreign_tables(file), str(file))


def refuse_unconfirmed_new_database(settings: Settings, *, new_database: bool) -> None:
    """Raise Conflict instead of creating an empty database where there was one before.

    There was one if a database is in quarantine, or if the data folder contains files that belong
    to one, such as backups or the list of erasures. Creating one is allowed once somebody has
    decided: by `new_database`, by a restored backup, or by a file put in its place.
    """
    file = database_file(settings)
    if file is not None:
        quarantine = Quarantine(file)
        unresolved = quarantine.unresolved()
        if unresolved:
            if not new_database and not (is_there(file) and _was_used(settings)):
                raise _damaged("the earlier database is damaged", unresolved[-1], settings)
            quarantine.resolve()
    if new_database or not _is_missing(settings):
        return
    traces = traces_of_a_database(settings)
    if traces:
        where = (
            "the database server has no Reembody database"
            if file is None
            else f"there is no {file}"
        )
        raise Conflict(
            f"{where}, but {home_of(settings)} contains what belongs to a database: "
            f"{', '.join(traces)}. No new one was created",
            value=traces,
            remedy="Put the database back (is its disk there, are the settings the same?), or "
            f"restore a backup: ./run restore FILE.{_newest_backup(settings)} Or begin an empty "
            "database, knowing what that means: ./run serve --new-database.",
        )


def bring_up_to_date(settings: Settings, clock: Clock) -> Path | None:
    """Create a database if there is none; migrate an older one, after backing it up.

    Returns the path of the backup, if one was made. Raises Conflict for the database of a newer
    program or of another one, which is left as it is, and NotDurable if the database cannot be used
    or the backup cannot be written: nothing is migrated then.
    """
    url, file = settings.resolved_database_url, database_file(settings)
    if file is not None and not is_there(file):
        create_database(file, clock)
        return None
    with errors_as_not_durable(
        f"the database {_name_of(settings)} cannot be used, and was left as it is"
    ):
        database = open_database(url)
        try:
            with database.reading() as db:
                found = _revision(db.connection())
            if found == newest_revision():
                return None
            backup = None if found is None else _keep(database, found, settings, clock)
        finally:
            database.close()
        migrate(url)
    return backup


@contextmanager
def created_if_missing(settings: Settings, clock: Clock) -> Iterator[None]:
    """Prepare the database for the block; if it is new and the block fails, delete it."""
    file = database_file(settings)
    created = file is not None and not is_there(file)
    bring_up_to_date(settings, clock)
    try:
        yield
    except BaseException:
        if created and file is not None and not is_open_elsewhere(file):
            for suffix in reversed(DATABASE_SUFFIXES):
                file.with_name(file.name + suffix).unlink(missing_ok=True)
        raise


def prepare_database(
    settings: Settings, clock: Clock, *, new_database: bool = False, to_write: bool = False
) -> Path | None:
    """Inspect, create, back up and migrate the database, for a command that uses it.

    `to_write`: also check that it can be written, as a server does. Raises NotDurable, or the
    errors of the single steps.
    """
    quarantine_if_damaged(settings, clock)
    refuse_unconfirmed_new_database(settings, new_database=new_database)
    backup = bring_up_to_date(settings, clock)
    if to_write:
        with errors_as_not_durable(f"the database {_name_of(settings)} cannot be written"):
            database = open_database(settings.resolved_database_url)
            try:
                with database.writing() as db:
                    db.connection()
            finally:
                database.close()
    return backup


def existing_database(settings: Settings) -> Database:
    """Open the existing database for reading, without preparing it.

    Raises NotFound if there is none, and Conflict if it has a second name.
    """
    file = database_file(settings)
    if file is not None and not is_there(file):
        raise NotFound(
            f"there is no database {file}",
            value=str(file),
            remedy="Set REEMBODY_DATA_DIR or REEMBODY_DATABASE_URL as for the server.",
        )
    require_one_name(settings)
    return open_database(settings.resolved_database_url)


def _revision(connection: Connection) -> str | None:
    """Return the revision, None for a database without tables; raise Conflict if unusable."""
    found = revision_of(connection)
    if found is None:
        _refuse_foreign(inspect(connection).get_table_names(), str(connection.engine.url.database))
    elif found not in all_revisions():
        raise Conflict(
            f"the database has the schema {found}, which version {__version__} does not know: "
            "a newer version has used it. It was left as it is",
            value=found,
            valid=list(all_revisions()),
            remedy="Start the newer version again, or restore a backup that this one can read.",
        )
    return found


def _keep(database: Database, revision: str, settings: Settings, clock: Clock) -> Path:
    folder = backups_of(settings)
    folder.mkdir(parents=True, exist_ok=True)
    to = stamped(folder, f"before-migration-{revision}", clock.utc_now())
    return back_up(database, to, clock=clock).path


def _was_used(settings: Settings) -> bool:
    """Return whether there is an account; an empty database after a failed restore has none."""
    database = open_database(settings.resolved_database_url)
    try:
        with database.reading() as db:
            connection = db.connection()
            if not inspect(connection).has_table("accounts"):
                return False
            return connection.scalar(select(func.count()).select_from(table("accounts"))) != 0
    finally:
        database.close()


def _refuse_foreign(tables: list[str], name: str) -> None:
    if tables:
        raise Conflict(
            f"{name} is a database of another program (it holds {', '.join(tables[:5])}); "
            "it was left as it is",
            value=name,
            remedy="Set REEMBODY_DATA_DIR or REEMBODY_DATABASE_URL to the right place.",
        )


def _quarantined(file: Path, damage: str, settings: Settings, clock: Clock) -> ReembodyError:
    """Move a damaged database into quarantine and return the error to raise."""
    try:
        place = Quarantine(file).put_away(damage, clock.utc_now())
    except OSError as error:
        words = f"the database {file} is damaged ({damage}), and it cannot be put into quarantine"
        return not_durable_error(words, error)
    return _damaged(f"the database {file} is damaged: {damage}", place, settings)


def _damaged(what: str, place: Path, settings: Settings) -> Damaged:
    return Damaged(
        f"{what}. It is in {place} with its log, unchanged",
        value=str(place),
        remedy=f"Restore the newest backup: ./run restore FILE.{_newest_backup(settings)} Or "
        "begin an empty database, knowing what that means: ./run serve --new-database.",
    )


def _newest_backup(settings: Settings) -> str:
    """Return a sentence on the newest automatic backup, if there is any."""
    folder = backups_of(settings)
    newest = max(folder.glob(f"*{ENDING}"), key=lambda path: path.stat().st_mtime, default=None)
    return "" if newest is None else f" The newest in {folder} is {newest.name}."


def _name_of(settings: Settings) -> str:
    """Return the database's name for a message: its file, or its name without a password."""
    file = database_file(settings)
    return str(file or make_url(settings.resolved_database_url).database)


def _is_missing(settings: Settings) -> bool:
    """Return whether there is no database yet."""
    file = database_file(settings)
    if file is not None:
        return not is_there(file)
    with errors_as_not_durable(f"the database {_name_of(settings)} cannot be used"):
        database = open_database(settings.resolved_database_url)
        try:
            with database.reading() as db:
                return not inspect(db.connection()).get_table_names()
        finally:
            database.close()


def create_database(file: Path, clock: Clock) -> None:
    """Create an empty database with the newest schema at `file`, atomically.

    A log found without its database is put into quarantine: SQLite would use it for the new one.
    Raises NotDurable if the database cannot be created; nothing is left of it then.
    """
    folder = file.absolute().parent
    with errors_as_not_durable(f"a new database cannot be created in {folder}"):
        if any(file.with_name(file.name + suffix).exists() for suffix in DATABASE_SUFFIXES[1:]):
            quarantine = Quarantine(file)
            quarantine.resolve(quarantine.put_away("its database is missing", clock.utc_now()))
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(
            prefix=BEGINNING, dir=folder, ignore_cleanup_errors=True
        ) as temporary:
            fresh = Path(temporary) / file.name
            make_file(fresh)
            flush_to_disk(fresh)
            if not is_there(file):
                fresh.rename(file)
                flush_to_disk(folder)
