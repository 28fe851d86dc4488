"""What happens to the database at every start, before anything works with it."""

import tempfile
from pathlib import Path

from sqlalchemy import Connection, func, inspect, select, table

from app import __version__
from app.clock import Clock
from app.database import Database, open_database
from app.errors import Conflict, NotFound
from app.features.care.backups import ENDING, back_up, stamped
from app.features.care.opening.inspection import damage_of, foreign_tables, is_open_elsewhere
from app.features.care.opening.quarantine import Quarantine, flush_to_disk
from app.platform.folders import backups_of, database_file
from app.schema_revisions import known_revisions, migrate, newest_revision, revision_of
from app.settings import Settings


def put_away_if_damaged(settings: Settings, clock: Clock) -> None:
    """Look at the embedded database; one that is damaged goes into quarantine, with its log.

    Raises Conflict if that happened, or if the file is another program's (it is left alone). Call
    it in a process that has not opened the database yet. While another process works with it
    nothing is looked at: that process did so when it started.
    """
    file = database_file(settings)
    if file is None:
        return
    quarantine = Quarantine(file)
    quarantine.finish()
    if not file.exists() or is_open_elsewhere(file):
        return
    damage = damage_of(file)
    if damage is not None:
        place = quarantine.put_away(damage, clock.utc_now())
        raise _damaged(f"the database {file} is damaged: {damage}", place, settings)
    _refuse_foreign(foreign_tables(file), str(file))


def refuse_to_begin_unasked(settings: Settings, *, new_database: bool) -> None:
    """An empty database is begun behind one in quarantine only if somebody says so.

    Raises Conflict as long as nobody has: neither `new_database`, nor a restored backup, nor a
    repaired file put in its place.
    """
    file = database_file(settings)
    if file is None:
        return
    quarantine = Quarantine(file)
    unresolved = quarantine.unresolved()
    if unresolved:
        if not new_database and not (file.exists() and _was_used(settings)):
            raise _damaged("the earlier database is damaged", unresolved[-1], settings)
        quarantine.resolve()


def bring_up_to_date(settings: Settings, clock: Clock) -> Path | None:
    """Begin a database where there is none; migrate an older one, after backing it up.

    Returns where the backup is, if one was made. Raises Conflict for the database of a newer
    program or of another one, which is left as it is, and NotDurable where the backup cannot be
    written: nothing is migrated then.
    """
    url, file = settings.resolved_database_url, database_file(settings)
    if file is not None and not file.exists():
        begin(file)
        return None
    database = open_database(url)
    try:
        with database.reading() as db:
            found = _revision(db.connection())
        if found == newest_revision():
            return None
        kept = None if found is None else _keep(database, found, settings, clock)
    finally:
        database.close()
    migrate(url)
    return kept


def prepare_database(
    settings: Settings, clock: Clock, *, new_database: bool = False
) -> Path | None:
    """All of the above, in this order, as a command that works with the database needs it."""
    put_away_if_damaged(settings, clock)
    refuse_to_begin_unasked(settings, new_database=new_database)
    return bring_up_to_date(settings, clock)


def existing_database(settings: Settings) -> Database:
    """The database as it is, to read from; raises NotFound where there is none."""
    file = database_file(settings)
    if file is not None and not file.is_file():
        raise NotFound(
            f"there is no database {file}",
            value=str(file),
            remedy="Set REEMBODY_DATA_DIR or REEMBODY_DATABASE_URL as for the server.",
        )
    return open_database(settings.resolved_database_url)


def _revision(connection: Connection) -> str | None:
    """The revision, None for a database without tables; raises Conflict for one of no use to us."""
    found = revision_of(connection)
    if found is None:
        _refuse_foreign(inspect(connection).get_table_names(), str(connection.engine.url.database))
    elif found not in known_revisions():
        raise Conflict(
            f"the database has the schema {found}, which version {__version__} does not know: "
            "a newer version has used it. It was left as it is",
            value=found,
            valid=list(known_revisions()),
            remedy="Start the newer version again, or restore a backup that this one can read.",
        )
    return found


def _keep(database: Database, revision: str, settings: Settings, clock: Clock) -> Path:
    folder = backups_of(settings)
    folder.mkdir(parents=True, exist_ok=True)
    to = stamped(folder, f"before-migration-{revision}", clock.utc_now())
    return back_up(database, to, clock=clock).path


def _was_used(settings: Settings) -> bool:
    """Whether anybody has an account: an empty database that a failed restore left has none."""
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


def _damaged(what: str, place: Path, settings: Settings) -> Conflict:
    folder = backups_of(settings)
    newest = max(folder.glob(f"*{ENDING}"), key=lambda path: path.stat().st_mtime, default=None)
    hint = "" if newest is None else f" The newest in {folder} is {newest.name}."
    return Conflict(
        f"{what}. It is in {place} with its log, unchanged",
        value=str(place),
        remedy="Restore the newest backup: reembody restore FILE." + hint + " Or begin an empty "
        "database, knowing what that means: reembody serve --new-database.",
    )


def begin(file: Path) -> None:
    """Make an empty database with the newest schema at `file`, where there is none."""
    folder = file.absolute().parent
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=".beginning-", dir=folder) as beside:
        fresh = Path(beside) / file.name
        # Its last connection copies the log into the file and removes it.
        migrate(f"sqlite:///{fresh}")
        flush_to_disk(fresh, folder)
        if not file.exists():
            fresh.rename(file)
