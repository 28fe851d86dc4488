"""List the schema revisions of this program, read a database's revision, and migrate it.

A revision is the name of the newest migration that was applied. A database may be older than the
program (it is migrated), or newer: then it was used by a newer program, and this one would not
understand its content.
"""

import errno
import sqlite3
from contextlib import closing
from functools import lru_cache
from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, column, inspect, select, table

from app.database import make_engine
from app.resources import migrations_dir

VERSION_TABLE = "alembic_version"


def alembic_config(url: str) -> Config:
    """Return Alembic's configuration for `url`, with the migrations that ship with the product."""
    config = Config()
    config.set_main_option("script_location", str(migrations_dir()))
    config.attributes["url"] = url
    return config


def migrate(url: str) -> None:
    """Migrate the schema of the database at `url` to the newest revision."""
    command.upgrade(alembic_config(url), "head")


def migrate_file(file: Path, revision: str = "head") -> None:
    """Migrate a SQLite file that no other program has open, so that the file alone is complete.

    SQLite's last connection copies the log into the file and removes it; if it cannot, it reports
    no error, and the file alone is then an incomplete database. Raises OSError in that case.
    """
    command.upgrade(alembic_config(f"sqlite:///{file}"), revision)
    _require_whole(file)


def make_file(file: Path, revision: str = "head") -> None:
    """Create a SQLite file with the schema of a revision and no content.

    The migrations are run only once per process. Raises OSError or sqlite3.Error if the file cannot
    be written, FileExistsError if it exists.
    """
    with file.open("xb") as new:
        new.write(_empty(newest_revision() if revision == "head" else revision))
    with closing(sqlite3.connect(file)) as connection:
        # The server uses WAL mode, which the in-memory database cannot have.
        connection.execute("PRAGMA journal_mode=WAL")
    _require_whole(file)


@lru_cache(maxsize=4)
def _empty(revision: str) -> bytes:
    """Return the bytes of an empty SQLite file with the schema of a revision."""
    config = alembic_config("sqlite://")
    engine = config.attributes["engine"] = make_engine("sqlite://")
    try:
        command.upgrade(config, revision)
        with engine.connect() as connection:
            driver = connection.connection.dbapi_connection
            assert isinstance(driver, sqlite3.Connection)  # noqa: S101 - it is a SQLite engine
            return driver.serialize()
    finally:
        engine.dispose()


def _require_whole(file: Path) -> None:
    log = file.with_name(f"{file.name}-wal")
    if log.exists():
        raise OSError(errno.EIO, "its log could not be copied into it", str(file))


@lru_cache(maxsize=1)
def all_revisions() -> tuple[str, ...]:
    """Return every revision of this program, oldest first."""
    script = ScriptDirectory.from_config(alembic_config("sqlite://"))
    return tuple(step.revision for step in script.walk_revisions())[::-1]


def newest_revision() -> str:
    """Return the revision that this program works with."""
    return all_revisions()[-1]


def revision_of(connection: Connection) -> str | None:
    """Return the revision of a database; None if no migration was ever applied."""
    if not inspect(connection).has_table(VERSION_TABLE):
        return None
    found: str | None = connection.scalar(
        select(column("version_num")).select_from(table(VERSION_TABLE))
    )
    return found
