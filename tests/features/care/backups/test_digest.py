"""Tests that a backup's checksums can be recomputed by hand."""

import hashlib
from pathlib import Path

from sqlalchemy import insert

from app.database import open_database
from app.features.care.backups.digest import TableDigest, overall
from app.features.care.backups.reading import opened_backup
from app.models import Study
from tests.features.care.backups.lab import NOW, make


def sha256(text: str) -> str:
    """Return the SHA-256 of an ASCII text in hexadecimal digits."""
    return hashlib.sha256(text.encode("ascii")).hexdigest()


def test_a_tables_checksum_is_that_of_its_lines(sqlite_url: str, tmp_path: Path) -> None:
    """A table's checksum is the SHA-256 of its column names and rows as lines of compact JSON."""
    database = open_database(sqlite_url)
    with database.writing() as db:
        for id_, key in (("b", "zwei"), ("a", "naïve")):
            db.execute(insert(Study).values(id=id_, key=key, created_at=NOW))
    make(database, tmp_path / "all.reembody")
    database.close()
    lines = (
        '["id","key","created_at","archived_at"]\n'
        '["a","na\\u00efve","2026-11-21 06:11:08.123456",null]\n'
        '["b","zwei","2026-11-21 06:11:08.123456",null]\n'
    )
    with opened_backup(tmp_path / "all.reembody") as backup:
        assert backup.tables["studies"] == TableDigest(2, sha256(lines))
        assert backup.tables["scores"] == TableDigest(
            0, sha256('["submission_id","score","value"]\n')
        )


def test_the_whole_checksum_is_that_of_the_tables() -> None:
    """A backup's checksum is the SHA-256 of its revision and each table's rows and checksum."""
    tables = {"b": TableDigest(2, "cd"), "a": TableDigest(1, "ef")}
    assert overall("0001", tables) == sha256('["0001",{"a":[1,"ef"],"b":[2,"cd"]}]\n')
