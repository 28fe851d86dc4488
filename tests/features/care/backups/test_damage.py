"""Tests that a damaged backup is detected before a restore changes anything."""

import sqlite3
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from app.database import Database, open_database
from app.errors import InvalidInput
from app.features.care.backups.reading import opened_backup
from tests.faults.figures import note
from tests.features.care.backups.lab import make, put_back
from tests.support.filled import contents, fill
from tests.support.sqlite import fresh_sqlite

pytestmark = pytest.mark.thorough

PAGE = 4096
FLIPS, MANY_FLIPS = 30, 3000
EVERY_PAGE, SOME_PAGES = 1, 12


@pytest.fixture
def backup(tmp_path: Path) -> Path:
    """Return an intact backup of a database whose pages are well filled."""
    source = open_database(fresh_sqlite(tmp_path / "source.sqlite"))
    fill(source.engine, rows=60)
    path = make(source, tmp_path / "all.reembody").path
    source.close()
    return path


def refused(path: Path) -> bool:
    """Return whether opening a backup file is refused as invalid."""
    try:
        with opened_backup(path):
            return False
    except InvalidInput:
        return True


def content(path: Path) -> object:
    """Open a backup and return its manifest and tables."""
    with opened_backup(path) as backup:
        return backup.manifest, backup.tables


@pytest.mark.parametrize("keep", [0, 15, 100, PAGE, 50 * PAGE, -PAGE, -1])
def test_a_truncated_backup_is_refused(backup: Path, keep: int) -> None:
    """A truncated backup is refused, whatever its length."""
    data = backup.read_bytes()
    backup.write_bytes(data[:keep])
    assert refused(backup)


def test_an_overwritten_page_is_detected(backup: Path) -> None:
    """A backup with a page of zeros or noise is refused, unless its rows are unaffected."""
    overwrite(backup, SOME_PAGES)


@pytest.mark.long
def test_every_overwritten_page_is_detected(backup: Path) -> None:
    """A backup with any single page overwritten is refused, unless its rows are unaffected."""
    overwrite(backup, EVERY_PAGE)


def overwrite(backup: Path, step: int) -> None:
    """Overwrite one page at a time of a backup; require that it is refused or reads the same."""
    rng = np.random.default_rng(6)
    data = backup.read_bytes()
    whole = content(backup)
    noticed = 0
    pages = range(0, len(data) // PAGE, step)
    for page in pages:
        noise = rng.bytes(PAGE) if page // step % 2 else bytes(PAGE)
        backup.write_bytes(data[: page * PAGE] + noise + data[(page + 1) * PAGE :])
        if refused(backup):
            noticed += 1
        else:
            # The page belongs to an index or is unused: all rows are intact.
            assert content(backup) == whole
    note(29, "backup, page overwritten", "refused", f"{noticed} of {len(pages)}")
    note(29, "backup, page overwritten", "wrong rows taken", 0)


def test_a_flipped_bit_never_changes_restored_rows(backup: Path) -> None:
    """A backup with a flipped bit is refused, unless its rows are unaffected."""
    flip_bits(backup, FLIPS)


@pytest.mark.long
def test_many_flipped_bits_never_change_restored_rows(backup: Path) -> None:
    """A backup with any of thousands of bits flipped is refused, unless its rows are unaffected."""
    flip_bits(backup, MANY_FLIPS)


def flip_bits(backup: Path, flips: int) -> None:
    """Flip one random bit at a time of a backup; require that it is refused or reads the same."""
    rng = np.random.default_rng(29)
    data = backup.read_bytes()
    whole = content(backup)
    noticed = 0
    for _ in range(flips):
        at, bit = int(rng.integers(len(data))), int(rng.integers(8))
        damaged = bytearray(data)
        damaged[at] ^= 1 << bit
        backup.write_bytes(damaged)
        if refused(backup):
            noticed += 1
        else:
            assert content(backup) == whole, (at, bit)
    note(29, "backup, bit flipped", "refused", f"{noticed} of {flips}")
    note(29, "backup, bit flipped", "wrong rows taken", 0)


@pytest.mark.parametrize(
    "change",
    [
        "UPDATE accounts SET role = 'admin '",
        "DELETE FROM session_events WHERE seq > 0",
        "INSERT INTO studies SELECT id || 'x', key || 'x', created_at, archived_at FROM studies",
        "UPDATE backup_manifest SET value = '2020-01-01T00:00:00+00:00' WHERE entry = 'made_at'",
        "UPDATE backup_manifest SET value = value || ' ' WHERE entry = 'tables'",
        "DELETE FROM backup_manifest WHERE entry = 'seal'",
        "DROP TABLE backup_manifest",
        "DROP TABLE login_tokens",
        "ALTER TABLE accounts RENAME COLUMN role TO roles",
    ],
)
def test_an_edited_backup_is_refused(backup: Path, change: str) -> None:
    """A backup whose rows, manifest or tables were edited with SQL is refused."""
    with closing(sqlite3.connect(backup)) as connection:
        connection.execute(change)
        connection.commit()
    assert refused(backup)


def test_a_file_of_another_kind_is_refused(sqlite: Database, tmp_path: Path) -> None:
    """A text file and a database that is not a backup are refused as backups."""
    (tmp_path / "some.txt").write_text("a text " * 1000)
    assert refused(tmp_path / "some.txt")
    sqlite.close()
    assert refused(tmp_path / "reembody.sqlite")


@pytest.mark.one_engine
def test_restoring_a_damaged_backup_changes_nothing(
    backup: Path, database: Database, tmp_path: Path
) -> None:
    """Restoring a damaged backup leaves the database, the backup file and its folder unchanged."""
    before = contents(database.engine)
    with closing(sqlite3.connect(backup)) as connection:
        connection.execute("UPDATE accounts SET role = 'admin'")
        connection.commit()
    data = backup.read_bytes()
    with pytest.raises(InvalidInput, match="accounts"):
        put_back(database, backup, replace=True, even_though_active=True)
    assert contents(database.engine) == before
    assert backup.read_bytes() == data
    assert not (tmp_path / "kept").exists()
