"""Tests that a restore brings back exactly the backed-up data, or changes nothing."""

import hashlib
from pathlib import Path

import pytest
from sqlalchemy import Connection, func, select, text, update

from app.database import Database, open_database
from app.errors import Conflict, InvalidInput, NotFound
from app.features.care.backups.rows import Row, write_rows
from app.features.care.backups.shapes import TableShape
from app.models import Account, Device, StudySession
from tests.faults.bench import SqliteBench
from tests.faults.interrupted import found
from tests.features.care.backups.lab import make, put_back
from tests.features.care.opening.older import EACH_OLDER, older_database
from tests.features.lab import Lab
from tests.support.filled import contents

pytestmark = pytest.mark.thorough


def test_restoring_across_engines_and_back_keeps_every_row(
    sqlite: Database, postgres_url: str, tmp_path: Path
) -> None:
    """Restoring from SQLite to PostgreSQL and back keeps every row and every checksum."""
    before = contents(sqlite.engine)
    first = make(sqlite, tmp_path / "1.reembody")
    postgres = open_database(postgres_url)
    into_postgres = put_back(postgres, tmp_path / "1.reembody")
    second = make(postgres, tmp_path / "2.reembody")
    postgres.close()
    back = put_back(sqlite, tmp_path / "2.reembody", replace=True)
    third = make(sqlite, tmp_path / "3.reembody")
    checksums = {one.sha256 for one in (first, into_postgres, second, back, third)}
    assert len(checksums) == 1
    assert contents(sqlite.engine) == before


def test_the_replaced_database_is_backed_up_first(database: Database, tmp_path: Path) -> None:
    """A restore that replaces a database first backs it up as it was."""
    make(database, tmp_path / "old.reembody")
    with database.writing() as db:
        db.execute(update(Account).values(role="new role"))
    new = make(database, tmp_path / "new.reembody")
    done = put_back(database, tmp_path / "old.reembody", replace=True)
    assert done.before is not None
    assert done.before.name == "before-restore-20261121T061108.123456Z.reembody"
    assert put_back(database, done.before, replace=True).sha256 == new.sha256


def test_a_database_with_rows_is_replaced_only_on_request(
    database: Database, tmp_path: Path
) -> None:
    """Without `replace`, a restore refuses a non-empty database and makes no backup of it."""
    make(database, tmp_path / "all.reembody")
    before = contents(database.engine)
    with pytest.raises(Conflict, match="not empty") as refused:
        put_back(database, tmp_path / "all.reembody")
    assert "--replace" in refused.value.remedy
    assert contents(database.engine) == before
    assert not (tmp_path / "kept").exists()


def test_a_restore_that_fails_changes_nothing(
    database: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A restore that fails after its last row is rolled back completely: it is one transaction."""
    make(database, tmp_path / "all.reembody")
    with database.writing() as db:
        db.execute(update(Account).values(role="new role"))
    before = contents(database.engine)

    def fail(*_: object) -> int:
        raise RuntimeError("the lights went out")

    monkeypatch.setattr("app.features.care.backups.service._unpair_headsets", fail)
    with pytest.raises(RuntimeError):
        put_back(database, tmp_path / "all.reembody", replace=True)
    assert contents(database.engine) == before


def test_a_restore_that_loses_rows_is_rolled_back(
    database: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A restore reads the written rows back and rolls back if they do not match the backup."""
    make(database, tmp_path / "all.reembody")
    before = contents(database.engine)

    def forgetful(connection: Connection, shape: TableShape, rows: list[Row]) -> None:
        write_rows(connection, shape, rows[1:] if shape.name == "scores" else rows)

    monkeypatch.setattr("app.features.care.backups.restoring.write_rows", forgetful)
    with pytest.raises(InvalidInput, match="scores does not match"):
        put_back(database, tmp_path / "all.reembody", replace=True)
    assert contents(database.engine) == before


@pytest.mark.one_engine
@pytest.mark.parametrize("revision", EACH_OLDER)
def test_an_older_backup_is_migrated_in_a_copy(
    database_url: str, tmp_path: Path, revision: str
) -> None:
    """Restoring an older backup gives the migrated database; the backup file is unchanged."""
    bench = SqliteBench(tmp_path)
    older = older_database(bench, revision)
    with bench.copy(older.url) as url:
        old = open_database(url)
        make(old, tmp_path / "old.reembody")
        old.close()
    bytes_before = hashlib.sha256((tmp_path / "old.reembody").read_bytes()).hexdigest()
    target = open_database(database_url)
    put_back(target, tmp_path / "old.reembody")
    make(target, tmp_path / "restored.reembody")
    target.close()
    assert hashlib.sha256((tmp_path / "old.reembody").read_bytes()).hexdigest() == bytes_before
    assert not list((tmp_path / "kept").iterdir())
    restored = found(f"sqlite:///{tmp_path / 'restored.reembody'}").contents
    del restored["backup_manifest"]
    assert restored == older.new.contents


def test_restoring_a_missing_file_is_reported(sqlite: Database, tmp_path: Path) -> None:
    """Restoring a missing file is reported as such, and no file is created at its path."""
    with pytest.raises(NotFound, match="no file"):
        put_back(sqlite, tmp_path / "nothing.reembody")
    assert not (tmp_path / "nothing.reembody").exists()


def test_active_sessions_block_a_restore(fresh_lab: Lab, tmp_path: Path) -> None:
    """A restore lists active sessions and refuses; if forced, it unpairs their headsets."""
    session = fresh_lab.join(participant_code="P-014")
    fresh_lab.command(session, "start")
    headset = fresh_lab.operator.post(
        f"/api/sessions/{session['id']}/pairings", json={"device": "headset"}
    ).json()
    fresh_lab.stranger().post(
        "/api/devices/pair", json={"code": headset["code"], "name": "headset"}
    ).raise_for_status()
    make(fresh_lab.database, tmp_path / "all.reembody")
    with pytest.raises(Conflict, match=r"1 session\(s\) are active: P-014") as refused:
        put_back(fresh_lab.database, tmp_path / "all.reembody", replace=True)
    assert refused.value.details[0]["session_id"] == session["id"]
    done = put_back(
        fresh_lab.database, tmp_path / "all.reembody", replace=True, even_though_active=True
    )
    assert done.unpaired == 1
    with fresh_lab.database.reading() as db:
        assert db.scalar(select(func.count(Device.revoked_at))) == 1
        assert db.scalar(select(StudySession.status)) == "active"


def test_a_running_application_continues_with_the_restored_data(
    fresh_lab: Lab, tmp_path: Path
) -> None:
    """After a restore the running application has exactly the sessions and ledger of the backup."""
    kept = fresh_lab.join(participant_code="before")
    make(fresh_lab.database, tmp_path / "all.reembody")
    later = fresh_lab.join(participant_code="later")
    put_back(fresh_lab.database, tmp_path / "all.reembody", replace=True)
    assert fresh_lab.view(kept["id"])["participant_code"] == "before"
    assert fresh_lab.operator.get(f"/api/sessions/{later['id']}").status_code == 404
    rejoined = fresh_lab.join(participant_code="later")
    assert rejoined["slot"] == later["slot"]
    started = fresh_lab.command(kept, "start")
    assert started["status"] == "active"


def test_no_table_uses_an_automatic_row_counter(database: Database) -> None:
    """Neither engine keeps an automatic row counter that a restore would have to set."""
    counters = (
        "SELECT name FROM sqlite_master WHERE name = 'sqlite_sequence'"
        if database.is_sqlite
        else "SELECT sequence_name FROM information_schema.sequences"
    )
    with database.reading() as db:
        assert db.execute(text(counters)).all() == []


def test_a_newer_programs_backup_is_refused(
    sqlite: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A backup from a newer program version is refused with the version that can read it."""
    make(sqlite, tmp_path / "all.reembody")
    monkeypatch.setattr("app.features.care.backups.reading.all_revisions", lambda: ("0001",))
    monkeypatch.setattr("app.features.care.backups.reading.newest_revision", lambda: "0001")
    with pytest.raises(InvalidInput, match="does not know") as refused:
        put_back(sqlite, tmp_path / "all.reembody", replace=True)
    assert "Install version" in refused.value.remedy
