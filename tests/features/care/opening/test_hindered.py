"""Tests that a healthy database that cannot be opened at present is left unchanged.

Errors of the disk itself are simulated in tests/faults/test_io_faults.py.
"""

import errno
import shutil
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from datetime import UTC, datetime
from pathlib import Path

import pytest
from sqlalchemy import text
from sqlalchemy.orm import Session

from app.clock import Clock
from app.database import open_database
from app.errors import Conflict, NotDurable
from app.features.care.opening.inspection import UNNAMED, UNREADABLE, damage_of, is_open_elsewhere
from app.features.care.opening.service import Damaged, created_if_missing, prepare_database
from app.schema_revisions import migrate_file
from app.settings import Settings
from tests.faults.bench import PostgresBench
from tests.features.care.opening.files import UNDECODABLE, edited, filled, killed
from tests.support.postgres import running_cluster

CLOCK = Clock(utc_now=lambda: datetime(2026, 11, 21, 6, 11, 8, 123456, UTC))
HOLD = """
import sqlite3, sys
connection = sqlite3.connect(sys.argv[1], isolation_level=None)
connection.execute("PRAGMA locking_mode=EXCLUSIVE")
connection.execute("BEGIN EXCLUSIVE")
connection.execute("DELETE FROM login_tokens WHERE 0")
print("locked_elsewhere", flush=True)
sys.stdin.read()
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Return the path of an intact Reembody database."""
    return filled(tmp_path / "reembody.sqlite")


@contextmanager
def locked_elsewhere(file: Path) -> Iterator[None]:
    """Lock a database exclusively from another process for the duration of the block."""
    with subprocess.Popen(
        [sys.executable, "-c", HOLD, str(file)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"locked_elsewhere\n"
        yield
        other.communicate()


def test_a_locked_database_is_left_in_place(file: Path, tmp_path: Path) -> None:
    """A database locked by another process is reported and not moved; later it opens normally."""
    settings = Settings(data_dir=tmp_path)
    with locked_elsewhere(file):
        assert is_open_elsewhere(file)
        with pytest.raises(NotDurable, match=r"locked"):
            prepare_database(settings, CLOCK, to_write=True)
    assert not (tmp_path / "quarantine").exists()
    prepare_database(settings, CLOCK, to_write=True)


@pytest.mark.parametrize("number", [errno.EIO, errno.EACCES, errno.EROFS, errno.ESTALE])
def test_an_unreadable_file_is_not_treated_as_damaged(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    """A database file without read permission is left in place, not quarantined."""
    original = Path.open

    def refusing(self: Path, *arguments: object, **more: object) -> object:
        if self.name == "reembody.sqlite":
            raise OSError(number, "refused", str(self))
        return original(self, *arguments, **more)  # type: ignore[call-overload]  # unchanged

    with monkeypatch.context() as patch:
        patch.setattr(Path, "open", refusing)
        with pytest.raises(NotDurable, match="cannot be read, and was left as it is: refused"):
            prepare_database(Settings(data_dir=tmp_path), CLOCK)
    prepare_database(Settings(data_dir=tmp_path), CLOCK)


def test_a_folder_in_place_of_the_database_is_reported(tmp_path: Path) -> None:
    """A folder at the path of the database file is reported as unreadable."""
    (tmp_path / "reembody.sqlite").mkdir()
    with pytest.raises(NotDurable, match="cannot be read"):
        prepare_database(Settings(data_dir=tmp_path), CLOCK)


def test_a_dangling_link_to_the_database_is_reported(tmp_path: Path) -> None:
    """A link to a database on a missing disk is reported, and no new database replaces it."""
    file = tmp_path / "reembody.sqlite"
    file.symlink_to(tmp_path / "unplugged" / "reembody.sqlite")
    with pytest.raises(Conflict, match=r"the link reembody\.sqlite"):
        prepare_database(Settings(data_dir=tmp_path), CLOCK)
    assert file.is_symlink()
    assert not (tmp_path / "unplugged").exists()


def test_damage_with_undecodable_messages_is_quarantined(file: Path, tmp_path: Path) -> None:
    """A database whose damage makes SQLite's error message undecodable is quarantined."""
    edited(file, UNDECODABLE)
    with pytest.raises(Damaged) as refused:
        prepare_database(Settings(data_dir=tmp_path), CLOCK)
    assert UNREADABLE in refused.value.message or "malformed" in refused.value.message
    assert (tmp_path / "quarantine").is_dir()


@pytest.mark.parametrize(
    ("statement", "message"),
    [
        ("UPDATE accounts SET role = CAST(x'61ff62' AS TEXT)", UNREADABLE),
        ("UPDATE accounts SET created_at = '2026-13-01 00:00:00'", "accounts.created_at"),
        ("UPDATE study_versions SET instruments = '{\"a' ", "study_versions.instruments"),
        ("UPDATE accounts SET all_studies = 7", "accounts.all_studies"),
        ("UPDATE alembic_version SET version_num = '00q1'", UNNAMED),
        ("UPDATE alembic_version SET version_num = '0000'", UNNAMED),
        ("DELETE FROM alembic_version", UNNAMED),
        ("ALTER TABLE alembic_version RENAME TO alembic_versioo", UNNAMED),
        ("ALTER TABLE accounts RENAME COLUMN role TO rolf", "there is no column accounts.role"),
        ("ALTER TABLE scores RENAME TO scorer", "there is no table scores"),
        ("UPDATE alembic_version SET version_num = '0001'", "of a later schema"),
        ("UPDATE alembic_version SET version_num = '0010'", "of a later schema"),
    ],
)
def test_content_that_this_program_never_writes_is_damage(
    file: Path, statement: str, message: str
) -> None:
    """Content that this program never writes counts as damage, even if SQLite's check passes."""
    edited(file, statement)
    assert message in (damage_of(file) or "")


@pytest.mark.parametrize("at", [16, 18, 19, 21, 44, 56])
def test_a_damaged_header_is_detected(file: Path, at: int) -> None:
    """A damaged file header counts as damage, even if SQLite can still read the file."""
    data = bytearray(file.read_bytes())
    data[at] ^= 0x60
    file.write_bytes(data)
    assert damage_of(file) is not None


def test_a_large_files_rows_are_checked_only_on_request(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The rows of a large database are checked only with `every_row`."""
    monkeypatch.setattr("app.features.care.opening.inspection.ROWS_READ_BYTES", 0)
    edited(file, "UPDATE accounts SET created_at = 'once'")
    assert damage_of(file) is None
    assert "accounts.created_at" in (damage_of(file, every_row=True) or "")


@pytest.mark.parametrize("trace", ["erasures.jsonl", "backups/1.reembody", "export/codebook.csv"])
def test_a_missing_database_is_reported_where_one_was_used(tmp_path: Path, trace: str) -> None:
    """A start without a database is refused if the data folder shows that there was one."""
    (tmp_path / trace).parent.mkdir(exist_ok=True)
    (tmp_path / trace).touch()
    settings = Settings(data_dir=tmp_path)
    with pytest.raises(Conflict, match=trace) as refused:
        prepare_database(settings, CLOCK)
    assert "--new-database" in refused.value.remedy
    assert not (tmp_path / "reembody.sqlite").exists()
    prepare_database(settings, CLOCK, new_database=True)
    prepare_database(settings, CLOCK)


def test_an_empty_postgresql_database_is_reported_where_one_was_used(tmp_path: Path) -> None:
    """A start with an empty PostgreSQL database is refused if the data folder shows earlier use."""
    (tmp_path / "erasures.jsonl").touch()
    with PostgresBench(running_cluster()).empty() as url:
        settings = Settings(data_dir=tmp_path, database_url=url)
        with pytest.raises(Conflict, match="has no Reembody database"):
            prepare_database(settings, CLOCK)
        prepare_database(settings, CLOCK, new_database=True)


def test_a_leftover_log_is_quarantined_before_a_new_database(tmp_path: Path) -> None:
    """A leftover write-ahead log is quarantined, so no new database replays it."""
    file = killed(filled(tmp_path / "reembody.sqlite"))
    log = Path(f"{file}-wal")
    content = log.read_bytes()
    file.unlink()
    settings = Settings(data_dir=tmp_path)
    with pytest.raises(Conflict, match="sqlite-wal"):
        prepare_database(settings, CLOCK)
    prepare_database(settings, CLOCK, new_database=True)
    assert damage_of(file) is None
    (kept,) = (tmp_path / "quarantine").glob("*/reembody.sqlite-wal")
    assert kept.read_bytes() == content


def test_a_database_created_for_a_failed_block_is_removed(tmp_path: Path) -> None:
    """`created_if_missing` removes the database that it created if its block fails."""
    settings = Settings(data_dir=tmp_path)
    with pytest.raises(NotADirectoryError), created_if_missing(settings, CLOCK):
        # The file exists; the error comes from treating it as a folder.
        list((tmp_path / "reembody.sqlite").iterdir())
    assert list(tmp_path.iterdir()) == []
    prepare_database(settings, CLOCK)
    with pytest.raises(RuntimeError), created_if_missing(settings, CLOCK):
        raise RuntimeError
    assert (tmp_path / "reembody.sqlite").is_file()


def test_a_migrated_file_with_an_unmerged_log_is_refused(tmp_path: Path) -> None:
    """Migrating a file fails if an open reader keeps its log from being merged into it."""
    file = tmp_path / "reembody.sqlite"
    migrate_file(file)
    other = tmp_path / "other.sqlite"
    shutil.copyfile(file, other)
    reader = open_database(f"sqlite:///{other}")
    with reader.reading() as db, pytest.raises(OSError, match="could not be copied"):
        migrate_file(_read(db, other))
    reader.close()


def _read(db: Session, file: Path) -> Path:
    db.execute(text("SELECT count(*) FROM accounts"))
    return file
