"""Tests that a database is created, migrated or refused before use, and never lost."""

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
    """Return a bench that makes databases, once for each engine."""
    return SqliteBench(tmp_path) if request.param == "sqlite" else PostgresBench(running_cluster())


def settings_for(url: str, folder: Path) -> Settings:
    """Return the settings of an installation with this database and data folder."""
    return Settings(database_url=url, data_dir=folder)


def backups_in(folder: Path) -> list[Path]:
    """Return the backups that the program made automatically in a data folder."""
    return sorted((folder / "backups").glob("*.reembody"))


def test_a_missing_database_is_created(bench: Bench, tmp_path: Path) -> None:
    """A missing database is created with the newest schema; preparing it again does nothing."""
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
    """An older database is backed up as it was, then migrated to the newest schema."""
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
def test_a_database_is_not_migrated_without_a_backup(
    bench: Bench, tmp_path: Path, revision: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An older database is not migrated if the disk has no space for its backup."""
    monkeypatch.setattr("app.features.care.backups.writing.SPARE_BYTES", 10**18)
    older = older_database(bench, revision)
    with bench.copy(older.url) as url:
        with pytest.raises(NotDurable, match="left; nothing was written"):
            prepare_database(settings_for(url, tmp_path), CLOCK)
        assert found(url) == older.old


def test_a_newer_programs_database_is_refused(bench: Bench, tmp_path: Path) -> None:
    """A database with a newer schema is refused with both revisions named, and stays unchanged."""
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


def test_another_programs_database_is_refused(bench: Bench, tmp_path: Path) -> None:
    """A database with the tables of another program is refused and stays unchanged."""
    with bench.empty() as url:
        database = open_database(url)
        with database.writing() as db:
            db.execute(text("CREATE TABLE bookmarks (x INTEGER)"))
        database.close()
        before = found(url)
        with pytest.raises(Conflict, match="another program"):
            prepare_database(settings_for(url, tmp_path), CLOCK)
        assert found(url) == before


def test_a_damaged_database_is_quarantined_and_not_replaced_silently(tmp_path: Path) -> None:
    """A damaged database is quarantined; no new one is made until `new_database` is given."""
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
    (quarantined,) = (tmp_path / "quarantine").glob("*/reembody.sqlite")
    assert quarantined.read_bytes() == damaged
    prepare_database(settings, CLOCK, new_database=True)
    prepare_database(settings, CLOCK)
    assert found(settings.resolved_database_url).revision == NEWEST
    assert quarantined.read_bytes() == damaged


def test_the_newest_backup_is_named(tmp_path: Path) -> None:
    """The error about a damaged database names the newest backup."""
    (tmp_path / "backups").mkdir()
    for at, name in enumerate(("old.reembody", "new.reembody")):
        (tmp_path / "backups" / name).touch()
        os.utime(tmp_path / "backups" / name, (at, at))
    (tmp_path / "reembody.sqlite").write_text("no database")
    with pytest.raises(Conflict) as refused:
        prepare_database(Settings(data_dir=tmp_path), CLOCK)
    assert "new.reembody" in refused.value.remedy


def test_an_intact_file_in_place_resolves_the_quarantine(tmp_path: Path) -> None:
    """An intact database in place of the quarantined one resolves the quarantine."""
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


def test_an_empty_database_does_not_resolve_the_quarantine(tmp_path: Path) -> None:
    """An empty database in place of the quarantined one does not resolve the quarantine."""
    file = filled(tmp_path / "reembody.sqlite")
    file.write_bytes(file.read_bytes()[:5000])
    settings = Settings(data_dir=tmp_path)
    with pytest.raises(Conflict):
        prepare_database(settings, CLOCK)
    bring_up_to_date(settings, CLOCK)
    assert file.exists()
    with pytest.raises(Conflict, match="the earlier database is damaged"):
        prepare_database(settings, CLOCK)


def test_creating_a_database_survives_being_killed(tmp_path: Path) -> None:
    """A start that is killed while it creates the database leaves no partial database."""
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


def test_reading_does_not_create_a_missing_database(tmp_path: Path) -> None:
    """Opening a missing database for reading is refused and creates no file."""
    with pytest.raises(NotFound, match="there is no database"):
        existing_database(Settings(data_dir=tmp_path))
    assert list(tmp_path.iterdir()) == []
