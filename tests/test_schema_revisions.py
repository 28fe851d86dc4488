"""Tests that a new database is created without migrations, but equals their result."""

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from app.schema_revisions import all_revisions, make_file, migrate_file


def contents(file: Path) -> tuple[set[str], list[object]]:
    """Return a description of the schema, independent of constraint order, and the rows."""
    with closing(sqlite3.connect(file)) as connection:
        schema = connection.execute("SELECT type, name, sql FROM sqlite_master").fetchall()
        asked = ("journal_mode", "page_size", "auto_vacuum", "encoding", "integrity_check")
        settings = [connection.execute(f"PRAGMA {one}").fetchone()[0] for one in asked]
        tables = [name for kind, name, _ in schema if kind == "table"]
        counts = [connection.execute(f"SELECT count(*) FROM {one}").fetchone()[0] for one in tables]  # noqa: S608 - names of the schema
    lines = {
        f"{kind} {name} {line.strip().rstrip(',')}"
        for kind, name, words in schema
        for line in (words or "").splitlines()
    }
    return lines, [settings, sorted(zip(tables, counts, strict=True))]


@pytest.mark.parametrize("revision", [all_revisions()[3], all_revisions()[-1]])
def test_a_new_file_equals_the_result_of_the_migrations(tmp_path: Path, revision: str) -> None:
    """A new file has the schema and settings that the migrations give, and no rows."""
    migrate_file(tmp_path / "steps.sqlite", revision)
    for name in ("first.sqlite", "again.sqlite"):
        make_file(tmp_path / name, revision)
        assert contents(tmp_path / name) == contents(tmp_path / "steps.sqlite")
    assert {one.suffix for one in tmp_path.iterdir()} == {".sqlite"}


def test_a_new_file_replaces_no_existing_one(tmp_path: Path) -> None:
    """An existing file is not replaced by a new one."""
    there = tmp_path / "reembody.sqlite"
    there.write_bytes(b"somebody's")
    with pytest.raises(FileExistsError):
        make_file(there)
    assert there.read_bytes() == b"somebody's"
