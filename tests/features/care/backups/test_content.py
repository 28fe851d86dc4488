"""What a backup holds is looked at before it goes into place, whatever its checksums say."""

import sqlite3
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import text

from app.database import Database, open_database
from app.errors import InvalidInput
from app.features.care.backups import RestoredContent
from app.features.care.backups.manifest import Manifest, read_manifest
from app.features.care.backups.manifest import write_manifest as seal
from app.features.care.backups.reading import digests, opened_copy
from app.features.care.backups.shapes import MANIFEST_TABLE, shapes_of
from tests.features.care.backups.lab import make, put_back
from tests.features.lab import PASSWORD, Lab, ok, running_lab
from tests.support.filled import contents
from tests.support.sqlite import fresh_sqlite


def forged(path: Path, *statements: str) -> Path:
    """A backup that was changed and sealed again: every checksum in it fits."""
    with closing(sqlite3.connect(path)) as connection:
        connection.execute("PRAGMA ignore_check_constraints=ON")
        for statement in statements:
            connection.execute(statement)
        connection.commit()
        before = read_manifest(connection)
    with opened_copy(path) as copy:
        tables = digests(copy, shapes_of(copy))
    with closing(sqlite3.connect(path)) as connection:
        connection.execute(f"DROP TABLE {MANIFEST_TABLE}")
        after = Manifest(
            before.made_at, before.product_version, before.revision, before.engine, tables
        )
        seal(connection, after)
        connection.commit()
        connection.execute("VACUUM")
    return path


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        ("CREATE TABLE more (x INTEGER PRIMARY KEY)", "the table more is not of this program"),
        ("ALTER TABLE accounts ADD COLUMN more TEXT", "column accounts.more is not of this"),
        (
            """ALTER TABLE accounts ADD COLUMN "id"", ""role" TEXT""",
            'column accounts.id", "role is not of this',
        ),
        ("ALTER TABLE accounts RENAME COLUMN role TO rolf", "no column accounts.role"),
        ("CREATE VIEW seen AS SELECT 1", "there is a view seen"),
        (
            "CREATE TRIGGER after DELETE ON scores BEGIN DELETE FROM answers; END",
            "there is a trigger after",
        ),
        ("UPDATE accounts SET created_at = 'once'", "accounts.created_at holds something else"),
        ("UPDATE accounts SET role = x'00ff'", "accounts.role holds something else"),
        ("UPDATE study_versions SET instruments = '{'", "study_versions.instruments holds"),
        ("UPDATE sessions SET study_id = 'nobody'", "refer to nothing"),
    ],
)
def test_tables_and_values_that_are_not_ours_are_refused(
    sqlite: Database, tmp_path: Path, statement: str, said: str
) -> None:
    """In words, with nothing changed."""
    make(sqlite, tmp_path / "all.reembody")
    before = contents(sqlite.engine)
    with pytest.raises(InvalidInput, match=said):
        put_back(sqlite, forged(tmp_path / "all.reembody", statement), replace=True)
    assert contents(sqlite.engine) == before
    assert not (tmp_path / "kept").exists()


@pytest.fixture
def lab(tmp_path: Path) -> Iterator[Lab]:
    """An installation with a session whose chain verifies."""
    (tmp_path / "lab").mkdir()
    with running_lab(fresh_sqlite(tmp_path / "lab" / "reembody.sqlite")) as running:
        credentials = {"username": "admin", "password": PASSWORD}
        ok(running.operator.post("/api/login", json=credentials))
        running.command(running.join(participant_code="P-014"), "start")
        yield running


@pytest.mark.parametrize(
    ("statement", "said"),
    [
        ("UPDATE accounts SET role = 'superadmin'", "role 'superadmin'"),
        ("UPDATE session_events SET actor = 'nobody' WHERE seq = 1", "chain of session"),
        ("DELETE FROM session_events WHERE seq = (SELECT max(seq) FROM session_events)", "session"),
        ("UPDATE audit_head SET seq = seq + 1", "the audit trail"),
    ],
)
def test_roles_and_chains_that_do_not_fit_are_refused(
    lab: Lab, database_url: str, tmp_path: Path, statement: str, said: str
) -> None:
    """Before they are committed, on both engines; a record is taken only by who insists."""
    make(lab.database, tmp_path / "all.reembody")
    backup = forged(tmp_path / "all.reembody", statement)
    target = open_database(database_url)
    options = {"even_though_active": True, "replace": True}
    with pytest.raises(InvalidInput, match=said):
        put_back(target, backup, content=RestoredContent(), **options)
    with target.reading() as db:
        assert db.scalar(text("SELECT count(*) FROM accounts")) == 0
    if "role" not in said:
        put_back(target, backup, content=RestoredContent(even_though_altered=True), **options)
        with target.reading() as db:
            assert db.scalar(text("SELECT count(*) FROM accounts")) == 1
    target.close()


def test_a_whole_record_is_taken(lab: Lab, database_url: str, tmp_path: Path) -> None:
    """On both engines."""
    make(lab.database, tmp_path / "all.reembody")
    target = open_database(database_url)
    done = put_back(
        target, tmp_path / "all.reembody", content=RestoredContent(), even_though_active=True
    )
    assert done.rows > 0
    target.close()


def test_the_backup_before_a_restore_that_failed_is_gone(lab: Lab, tmp_path: Path) -> None:
    """What was to be replaced is still there: nobody needs one copy of people's data more."""
    make(lab.database, tmp_path / "all.reembody")
    forged(tmp_path / "all.reembody", "UPDATE accounts SET role = 'superadmin'")
    with pytest.raises(InvalidInput):
        put_back(
            lab.database,
            tmp_path / "all.reembody",
            content=RestoredContent(),
            replace=True,
            even_though_active=True,
        )
    assert list((tmp_path / "kept").iterdir()) == []
