"""A damaged backup is noticed before anything is touched."""

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

PAGE = 4096
FLIPS, MANY_FLIPS = 30, 3000
EVERY_PAGE, SOME_PAGES = 1, 12


@pytest.fixture
def backup(tmp_path: Path) -> Path:
    """A backup that is whole, of a database whose pages are well filled."""
    source = open_database(fresh_sqlite(tmp_path / "source.sqlite"))
    fill(source.engine, rows=60)
    path = make(source, tmp_path / "all.reembody").path
    source.close()
    return path


def refused(path: Path) -> bool:
    """Whether a file is not taken; one that is taken must hold what was backed up."""
    try:
        with opened_backup(path):
            return False
    except InvalidInput:
        return True


def content(path: Path) -> object:
    """Everything in the tables of a backup that was taken."""
    with opened_backup(path) as backup:
        return backup.manifest, backup.tables


@pytest.mark.parametrize("keep", [0, 15, 100, PAGE, 50 * PAGE, -PAGE, -1])
def test_a_file_that_was_cut_off_is_refused(backup: Path, keep: int) -> None:
    """Wherever it ends."""
    data = backup.read_bytes()
    backup.write_bytes(data[:keep])
    assert refused(backup)


def test_a_page_that_was_overwritten_is_noticed(backup: Path) -> None:
    """With zeros or noise: refused, or nothing was in it."""
    overwrite(backup, SOME_PAGES)


@pytest.mark.long
def test_every_page_that_was_overwritten_is_noticed(backup: Path) -> None:
    """The same with all of them."""
    overwrite(backup, EVERY_PAGE)


def overwrite(backup: Path, step: int) -> None:
    """Overwrite one page after the other, each in a whole file."""
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
            # An index, or an unused page: the rows are all there.
            assert content(backup) == whole
    note(29, "backup, page overwritten", "refused", f"{noticed} of {len(pages)}")
    note(29, "backup, page overwritten", "wrong rows taken", 0)


def test_a_flipped_bit_never_gets_through(backup: Path) -> None:
    """Refused, or it was a bit that no row needs."""
    flip_bits(backup, FLIPS)


@pytest.mark.long
def test_many_flipped_bits_never_get_through(backup: Path) -> None:
    """The same with many more."""
    flip_bits(backup, MANY_FLIPS)


def flip_bits(backup: Path, flips: int) -> None:
    """Flip one bit after the other, each in a whole file."""
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
def test_an_edited_file_is_refused(backup: Path, change: str) -> None:
    """By whatever tool."""
    with closing(sqlite3.connect(backup)) as connection:
        connection.execute(change)
        connection.commit()
    assert refused(backup)


def test_a_file_of_another_kind_is_refused(sqlite: Database, tmp_path: Path) -> None:
    """A text, and a database that is no backup."""
    (tmp_path / "some.txt").write_text("a text " * 1000)
    assert refused(tmp_path / "some.txt")
    sqlite.close()
    assert refused(tmp_path / "reembody.sqlite")


@pytest.mark.one_engine
def test_nothing_is_touched_by_a_damaged_one(
    backup: Path, database: Database, tmp_path: Path
) -> None:
    """Neither the database, nor the file, nor the folder."""
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
