"""Before anything works with a database it is begun, migrated or refused, never lost."""

import os
import signal
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import pytest
from sqlalchemy import text

from app.clock import Clock
from app.database import open_database
from app.errors import Conflict, NotDurable, NotFound
from app.features.care.backups.reading import opened_backup
from app.features.care.opening.service import (
    bring_up_to_date,
    existing_database,
    prepare_database,
)
from app.schema_revisions import migrate
from app.settings import Settings
from tests.faults.bench import Bench, PostgresBench, SqliteBench
from tests.faults.interrupted import found, steps
from tests.features.care.opening.files import filled
from tests.features.care.opening.older import EACH_OLDER, NEWEST, older_database
from tests.support.filled import fill
from tests.support.postgres import running_cluster

NOW = datetime(2026, 11, 21, 6, 11, 8, 123456, UTC)
CLOCK = Clock(utc_now=lambda: NOW)


@pytest.fixture(params=["sqlite", "postgresql"])
def bench(request: pytest.FixtureRequest, tmp_path: Path) -> Bench:
    """Where databases are made."""
    return SqliteBench(tmp_path) if request.param == "sqlite" else PostgresBench(running_cluster())


def settings_for(url: str, folder: Path) -> Settings:
    """An installation on this database."""
    return Settings(database_url=url, data_dir=folder)


def backups_in(folder: Path) -> list[Path]:
    """The backups that were made on our own account."""
    return sorted((folder / "backups").glob("*.reembody"))


def test_where_there_is_none_a_database_is_begun(bench: Bench, tmp_path: Path) -> None:
    """It has the newest schema; opening it again does nothing."""
    with bench.empty() as url:
        settings = settings_for(url, tmp_path)
        prepare_database(settings, CLOCK)
        assert found(url).revision == NEWEST
        prepare_database(settings, CLOCK)
        assert backups_in(tmp_path) == []


@pytest.mark.parametrize("revision", EACH_OLDER)
def test_an_older_database_is_backed_up_and_migrated(
    bench: Bench, tmp_path: Path, revision: str
) -> None:
    """The backup is the database as it was; then it is the same as migrated by hand."""
    older = older_database(bench, revision)
    with bench.copy(older.url) as url:
        kept = prepare_database(settings_for(url, tmp_path), CLOCK)
        assert found(url) == older.new
        assert kept is not None
        assert kept.name == f"before-migration-{revision}-20261121T061108.123456Z.reembody"
        assert backups_in(tmp_path) == [kept]
        with opened_backup(kept) as backup:
            rows = {name: table.rows for name, table in backup.tables.items()}
            assert backup.manifest.revision == revision
        assert rows == {name: len(those) for name, those in older.old.contents.items()}


@pytest.mark.parametrize("revision", EACH_OLDER)
def test_without_a_backup_nothing_is_migrated(
    bench: Bench, tmp_path: Path, revision: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A full disk leaves the older database as it was."""
    monkeypatch.setattr("app.features.care.backups.writing.SPARE_BYTES", 10**18)
    older = older_database(bench, revision)
    with bench.copy(older.url) as url:
        with pytest.raises(NotDurable, match="left; nothing was written"):
            prepare_database(settings_for(url, tmp_path), CLOCK)
        assert found(url) == older.old


def test_a_newer_programs_database_is_left_alone(bench: Bench, tmp_path: Path) -> None:
    """Refused with both revisions named, and not a row is changed."""
    with bench.empty() as url:
        migrate(url)
        database = open_database(url)
        fill(database.engine)
        with database.writing() as db:
            db.execute(text("UPDATE alembic_version SET version_num = '9999'"))
        database.close()
        before = found(url)
        with pytest.raises(Conflict, match="schema 9999, which version") as refused:
            prepare_database(settings_for(url, tmp_path), CLOCK)
        assert refused.value.valid == [after for _, after in steps()]
        assert found(url) == before


def test_another_programs_database_is_left_alone(bench: Bench, tmp_path: Path) -> None:
    """We do not put our tables beside somebody else's."""
    with bench.empty() as url:
        database = open_database(url)
        with database.writing() as db:
            db.execute(text("CREATE TABLE bookmarks (x INTEGER)"))
        database.close()
        before = found(url)
        with pytest.raises(Conflict, match="another program"):
            prepare_database(settings_for(url, tmp_path), CLOCK)
        assert found(url) == before


def test_a_damaged_database_is_put_away_and_none_is_begun_in_silence(tmp_path: Path) -> None:
    """Not at this start and not at the next; only when somebody says so."""
    file = filled(tmp_path / "reembody.sqlite")
    file.write_bytes(b"\0" * 5000 + file.read_bytes()[5000:])
    damaged = file.read_bytes()
    settings = Settings(data_dir=tmp_path)
    for _ in range(3):
        with pytest.raises(Conflict, match="is damaged") as refused:
            prepare_database(settings, CLOCK)
        assert "./run restore FILE" in refused.value.remedy
        assert "--new-database" in refused.value.remedy
        assert not file.exists()
    (held,) = (tmp_path / "quarantine").glob("*/reembody.sqlite")
    assert held.read_bytes() == damaged
    prepare_database(settings, CLOCK, new_database=True)
    prepare_database(settings, CLOCK)
    assert found(settings.resolved_database_url).revision == NEWEST
    assert held.read_bytes() == damaged


def test_the_newest_backup_is_named(tmp_path: Path) -> None:
    """Whoever reads the message should not have to look for it."""
    (tmp_path / "backups").mkdir()
    for at, name in enumerate(("old.reembody", "new.reembody")):
        (tmp_path / "backups" / name).touch()
        os.utime(tmp_path / "backups" / name, (at, at))
    (tmp_path / "reembody.sqlite").write_text("no database")
    with pytest.raises(Conflict) as refused:
        prepare_database(Settings(data_dir=tmp_path), CLOCK)
    assert "new.reembody" in refused.value.remedy


def test_a_good_file_in_its_place_resolves_it(tmp_path: Path) -> None:
    """A repaired database, or a restored one, is what somebody decided for."""
    file = filled(tmp_path / "reembody.sqlite")
    good = file.read_bytes()
    file.write_bytes(good[:5000])
    settings = Settings(data_dir=tmp_path)
    with pytest.raises(Conflict):
        prepare_database(settings, CLOCK)
    file.write_bytes(good)
    prepare_database(settings, CLOCK)
    file.unlink()
    with pytest.raises(Conflict, match="contains what belongs to a database: quarantine"):
        prepare_database(settings, CLOCK)
    assert not file.exists()


def test_an_empty_database_in_its_place_does_not(tmp_path: Path) -> None:
    """Half a restore is no decision: nobody has an account in it."""
    file = filled(tmp_path / "reembody.sqlite")
    file.write_bytes(file.read_bytes()[:5000])
    settings = Settings(data_dir=tmp_path)
    with pytest.raises(Conflict):
        prepare_database(settings, CLOCK)
    bring_up_to_date(settings, CLOCK)
    assert file.exists()
    with pytest.raises(Conflict, match="the earlier database is damaged"):
        prepare_database(settings, CLOCK)


def test_a_killed_beginning_is_begun_again(tmp_path: Path) -> None:
    """There is never half of a new database, whenever the process dies."""
    program = (
        "import os, signal, sys, threading\n"
        "from pathlib import Path\n"
        "from app.clock import Clock\n"
        "from app.features.care.opening.service import prepare_database\n"
        "from app.settings import Settings\n"
        "settings = Settings(data_dir=Path(sys.argv[1]))\n"
        "after_s = float(sys.argv[2])\n"
        "threading.Timer(after_s, os.kill, (os.getpid(), signal.SIGKILL)).start()\n"
        "prepare_database(settings, Clock())\n"
        "os.kill(os.getpid(), signal.SIGKILL)\n"
    )
    for at, after_s in enumerate((0.02, 0.08, 1.0)):
        folder = tmp_path / str(at)
        folder.mkdir()
        ended = subprocess.run(
            [sys.executable, "-c", program, str(folder), str(after_s)], check=False
        )
        assert ended.returncode == -signal.SIGKILL
        prepare_database(Settings(data_dir=folder), CLOCK)
        assert found(f"sqlite:///{folder / 'reembody.sqlite'}").revision == NEWEST


def test_a_missing_database_is_not_made_by_reading_it(tmp_path: Path) -> None:
    """A backup of the wrong folder says so."""
    with pytest.raises(NotFound, match="there is no database"):
        existing_database(Settings(data_dir=tmp_path))
    assert list(tmp_path.iterdir()) == []
