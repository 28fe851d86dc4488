"""Tests of what keeps SQLite's log in place while connections come and go."""

from pathlib import Path

from sqlalchemy import text

from app.database import open_database


def test_the_log_outlives_the_last_pooled_connection(tmp_path: Path) -> None:
    """A full disk has no room for a new index of the log, so a reader needs the one there is."""
    file = tmp_path / "study.db"
    database = open_database(f"sqlite:///{file}")
    index = file.with_name("study.db-shm")
    with database.writing() as db:
        db.execute(text("CREATE TABLE one (number INTEGER)"))
    database.engine.pool.dispose()
    assert index.exists()
    database.close()
    assert not index.exists()
