"""Give each test a migrated SQLite file, copied from one that is migrated once per run."""

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

from tests.support.shared_run import once, run_folder


def fresh_sqlite(path: Path) -> str:
    """Create a migrated, empty database at `path` and return its URL."""
    shutil.copyfile(_template(), path)
    return f"sqlite:///{path}"


def _template() -> Path:
    template = run_folder() / "template.sqlite"
    with once("sqlite-template") as mark:
        if mark:
            from app.schema_revisions import migrate

            migrate(f"sqlite:///{template}")
            # Move everything into the one file that is copied.
            with closing(sqlite3.connect(template)) as connection:
                connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
            mark.touch()
    return template
