"""Which schemas this program knows, which one a database has, and how it gets the newest.

A revision is the name of the newest migration that was applied. A database may be older than the
program (it is migrated), or newer: then it was used by a newer program, and an older one would not
understand what it finds.
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
    """Alembic's configuration for `url`, pointing at the migrations that ship with the product."""
    config = Config()
    config.set_main_option("script_location", str(migrations_dir()))
    config.attributes["url"] = url
    return config


def migrate(url: str) -> None:
    """Bring the schema of `url` to the newest version, from whatever version it has."""
    command.upgrade(alembic_config(url), "head")


def migrate_file(file: Path, revision: str = "head") -> None:
    """The same for a SQLite file that nobody else has open, so that all of it is in the file.

    The last connection copies the log into the file and removes it; where it cannot, it says
    nothing, and whoever then moves or reads the file alone has half of it. Raises OSError for that.
    """
    command.upgrade(alembic_config(f"sqlite:///{file}"), revision)
    _require_whole(file)


def make_file(file: Path, revision: str = "head") -> None:
    """A new SQLite file with the schema of a revision and nothing in it.

    The steps to it are taken once in a process. Raises OSError or sqlite3.Error where it cannot be
    written; FileExistsError where there is one.
    """
    with file.open("xb") as new:
        new.write(_empty(newest_revision() if revision == "head" else revision))
    with closing(sqlite3.connect(file)) as connection:
        # As whoever works with it would have it; what it is in memory has no log.
        connection.execute("PRAGMA journal_mode=WAL")
    _require_whole(file)


@lru_cache(maxsize=4)
def _empty(revision: str) -> bytes:
    """What a SQLite file with the schema of a revision holds before anything is in it."""
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
def known_revisions() -> tuple[str, ...]:
    """Every revision of this program, oldest first."""
    script = ScriptDirectory.from_config(alembic_config("sqlite://"))
    return tuple(step.revision for step in script.walk_revisions())[::-1]


def newest_revision() -> str:
    """The revision that this program works with."""
    return known_revisions()[-1]


def revision_of(connection: Connection) -> str | None:
    """The revision of a database; None where no migration was ever applied."""
    if not inspect(connection).has_table(VERSION_TABLE):
        return None
    found: str | None = connection.scalar(
        select(column("version_num")).select_from(table(VERSION_TABLE))
    )
    return found
