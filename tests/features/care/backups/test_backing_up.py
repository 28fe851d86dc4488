"""Tests of backups: each is a consistent snapshot, and an incomplete file never remains."""

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import pytest
from sqlalchemy import func, insert, select, update

from app.database import Database, open_database
from app.errors import Conflict, NotDurable, NotFound
from app.features.care.backups.manifest import read_manifest
from app.models import Account, SessionEvent
from tests.faults.bench import SqliteBench
from tests.faults.interrupted import steps
from tests.features.care.backups.lab import NOW, make
from tests.features.care.opening.older import EACH_OLDER, older_database
from tests.support.filled import ROWS, contents, fill, tables_of


def left_in(folder: Path) -> list[str]:
    """Return the names of all files in a folder, hidden ones too, except the source database's."""
    return sorted(path.name for path in folder.iterdir() if "reembody.sqlite" not in path.name)


def test_a_backup_holds_every_row_of_every_table(database: Database, tmp_path: Path) -> None:
    """A backup that is read back contains every row of every table of the database."""
    done = make(database, tmp_path / "all.reembody")
    copy = open_database(f"sqlite:///{tmp_path / 'all.reembody'}")
    copied = contents(copy.engine)
    del copied["backup_manifest"]
    with database.engine.connect() as connection:
        names = {table.name for table in tables_of(connection)}
    copy.close()
    assert copied.keys() == names
    expected = contents(database.engine)
    if not database.is_sqlite:
        # SQLite stores neither time zones nor booleans; both are compared as SQLite stores them.
        expected = {
            name: [
                {
                    key: value.replace(tzinfo=None) if hasattr(value, "tzinfo") else value
                    for key, value in row.items()
                }
                for row in rows
            ]
            for name, rows in expected.items()
        }
    assert copied == expected
    assert done.rows == ROWS * len(names)
    assert done.size_bytes == (tmp_path / "all.reembody").stat().st_size


def test_a_backups_manifest_states_time_engine_and_schema(
    database: Database, tmp_path: Path
) -> None:
    """A backup states its time, engine, schema and checksum; only its owner may read the file."""
    done = make(database, tmp_path / "all.reembody")
    with closing(sqlite3.connect(tmp_path / "all.reembody")) as connection:
        manifest = read_manifest(connection)
    assert manifest.made_at == NOW
    assert manifest.revision == steps()[-1][1] == done.revision
    assert manifest.engine == database.engine.dialect.name
    assert manifest.sha256 == done.sha256
    assert (tmp_path / "all.reembody").stat().st_mode & 0o077 == 0


def test_both_engines_give_the_same_checksum(
    sqlite_url: str, postgres_url: str, tmp_path: Path
) -> None:
    """Equal rows give equal checksums on both engines; one changed value gives another checksum."""
    found = []
    for at, url in enumerate((sqlite_url, postgres_url)):
        opened = open_database(url)
        fill(opened.engine)
        found.append(make(opened, tmp_path / f"{at}.reembody").sha256)
        with opened.writing() as db:
            db.execute(update(Account).values(role="somebody else"))
        found.append(make(opened, tmp_path / f"{at}-changed.reembody").sha256)
        opened.close()
    assert found[0] == found[2]
    assert found[1] == found[3]
    assert found[0] != found[1]


def test_rows_written_during_a_backup_are_not_in_it(database: Database, tmp_path: Path) -> None:
    """A backup is a snapshot: rows written while its tables are copied are not in it."""
    alone = make(database, tmp_path / "alone.reembody")
    tables = iter(range(1000, 2000))

    def write(_table: str, _rows: int) -> None:
        with database.writing() as db:
            first = db.execute(select(SessionEvent.__table__).limit(1)).mappings().one()
            db.execute(insert(SessionEvent).values({**first, "seq": next(tables)}))
            db.execute(update(Account).values(role=f"role {next(tables)}"))

    busy = make(database, tmp_path / "busy.reembody", progress=write)
    assert busy.sha256 == alone.sha256
    with database.reading() as db:
        assert (db.scalar(select(func.count()).select_from(SessionEvent)) or 0) > 2 * ROWS


@pytest.mark.parametrize("there", ["file", "folder", "link"])
def test_a_backup_never_overwrites_an_existing_path(
    sqlite: Database, tmp_path: Path, there: str
) -> None:
    """A backup to the path of an existing file, folder or link is refused and changes nothing."""
    place = tmp_path / "taken.reembody"
    if there == "file":
        place.write_text("mine")
    elif there == "folder":
        place.mkdir()
    else:
        place.symlink_to(tmp_path / "nowhere")
    with pytest.raises(Conflict, match="already"):
        make(sqlite, place)
    assert left_in(tmp_path) == ["taken.reembody"]
    assert there != "file" or place.read_text() == "mine"


def test_a_backup_does_not_create_a_missing_folder(sqlite: Database, tmp_path: Path) -> None:
    """A backup to a missing folder is refused: the folder may be a disk that is not plugged in."""
    with pytest.raises(NotFound, match="no folder"):
        make(sqlite, tmp_path / "usb" / "all.reembody")
    assert left_in(tmp_path) == []


def test_a_full_disk_leaves_no_incomplete_backup(
    sqlite: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A backup that fills the disk leaves no file, whichever table no longer fits."""
    for pages in (140, 160, 180):
        monkeypatch.setattr(
            "app.features.care.backups.writing._FOR_ONE_WRITER",
            ("journal_mode=DELETE", "journal_mode=OFF", f"max_page_count={pages}"),
        )
        with sqlite.writing() as db:
            events = [{**_an_event(sqlite), "seq": seq} for seq in range(pages * 100, pages * 110)]
            db.execute(insert(SessionEvent), events)
        with pytest.raises(NotDurable, match="full"):
            make(sqlite, tmp_path / "all.reembody")
        assert left_in(tmp_path) == []


def _an_event(database: Database) -> dict[str, object]:
    with database.reading() as db:
        return dict(db.execute(select(SessionEvent.__table__).limit(1)).mappings().one())


def test_a_backup_without_enough_disk_space_is_not_started(
    database: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A backup is refused before it writes if the disk has too little space for it."""
    usage = shutil.disk_usage(tmp_path)
    monkeypatch.setattr(shutil, "disk_usage", lambda _: usage._replace(free=60_000_000))
    with pytest.raises(NotDurable, match="60 MB left"):
        make(database, tmp_path / "all.reembody")
    assert left_in(tmp_path) == []


def test_a_database_without_our_tables_is_not_backed_up(tmp_path: Path) -> None:
    """Backing up a database without Reembody's tables is refused: the backup would be empty."""
    wrong = open_database(f"sqlite:///{tmp_path / 'wrong.sqlite'}")
    with pytest.raises(NotFound, match="no Reembody database"):
        make(wrong, tmp_path / "all.reembody")
    wrong.close()


@pytest.mark.parametrize("revision", EACH_OLDER)
def test_an_older_schema_is_backed_up_unchanged(tmp_path: Path, revision: str) -> None:
    """A database with an older schema is backed up without being migrated."""
    bench = SqliteBench(tmp_path)
    with bench.copy(older_database(bench, revision).url) as url:
        old = open_database(url)
        assert make(old, tmp_path / "old.reembody").revision == revision
        old.close()
