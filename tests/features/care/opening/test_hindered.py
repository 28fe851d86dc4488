"""A healthy database stays where it is, whatever keeps a start from it, and so does what it means.

Refusals of the disk itself are made to happen in tests/faults/test_io_faults.py.
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
print("held", flush=True)
sys.stdin.read()
"""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A database of ours that is whole."""
    return filled(tmp_path / "reembody.sqlite")


@contextmanager
def held(file: Path) -> Iterator[None]:
    """Another process has it all to itself."""
    with subprocess.Popen(
        [sys.executable, "-c", HOLD, str(file)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"held\n"
        yield
        other.communicate()


def test_a_database_that_somebody_holds_is_left_alone(file: Path, tmp_path: Path) -> None:
    """One sentence, and nothing is moved; afterwards it is an ordinary start."""
    settings = Settings(data_dir=tmp_path)
    with held(file):
        assert is_open_elsewhere(file)
        with pytest.raises(NotDurable, match=r"locked"):
            prepare_database(settings, CLOCK, to_write=True)
    assert not (tmp_path / "quarantine").exists()
    prepare_database(settings, CLOCK, to_write=True)


@pytest.mark.parametrize("number", [errno.EIO, errno.EACCES, errno.EROFS, errno.ESTALE])
def test_a_file_that_cannot_be_read_is_not_damaged(
    file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, number: int
) -> None:
    """Nothing is known of it, so nothing is done with it."""
    honest = Path.open

    def refusing(self: Path, *arguments: object, **more: object) -> object:
        if self.name == "reembody.sqlite":
            raise OSError(number, "refused", str(self))
        return honest(self, *arguments, **more)  # type: ignore[call-overload]  # passed on as it came

    with monkeypatch.context() as patch:
        patch.setattr(Path, "open", refusing)
        with pytest.raises(NotDurable, match="cannot be read, and was left as it is: refused"):
            prepare_database(Settings(data_dir=tmp_path), CLOCK)
    prepare_database(Settings(data_dir=tmp_path), CLOCK)


def test_a_folder_in_its_place_is_said(tmp_path: Path) -> None:
    """And left."""
    (tmp_path / "reembody.sqlite").mkdir()
    with pytest.raises(NotDurable, match="cannot be read"):
        prepare_database(Settings(data_dir=tmp_path), CLOCK)


def test_a_link_into_a_disk_that_is_not_there_is_said(tmp_path: Path) -> None:
    """No new database takes the link's place."""
    file = tmp_path / "reembody.sqlite"
    file.symlink_to(tmp_path / "unplugged" / "reembody.sqlite")
    with pytest.raises(Conflict, match=r"the link reembody\.sqlite"):
        prepare_database(Settings(data_dir=tmp_path), CLOCK)
    assert file.is_symlink()
    assert not (tmp_path / "unplugged").exists()


def test_damage_that_makes_messages_undecodable_is_damage(file: Path, tmp_path: Path) -> None:
    """SQLite quotes what it cannot understand, and the driver cannot decode that."""
    edited(file, UNDECODABLE)
    with pytest.raises(Damaged) as refused:
        prepare_database(Settings(data_dir=tmp_path), CLOCK)
    assert UNREADABLE in refused.value.message or "malformed" in refused.value.message
    assert (tmp_path / "quarantine").is_dir()


@pytest.mark.parametrize(
    ("statement", "said"),
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
    file: Path, statement: str, said: str
) -> None:
    """Where SQLite's own check finds nothing."""
    edited(file, statement)
    assert said in (damage_of(file) or "")


@pytest.mark.parametrize("at", [16, 18, 19, 21, 44, 56])
def test_a_damaged_header_is_damage(file: Path, at: int) -> None:
    """Also where SQLite reads on, and only writing would fail."""
    data = bytearray(file.read_bytes())
    data[at] ^= 0x60
    file.write_bytes(data)
    assert damage_of(file) is not None


def test_a_large_files_rows_are_read_when_asked(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a start that failed, and before a restore."""
    monkeypatch.setattr("app.features.care.opening.inspection.ROWS_READ_BYTES", 0)
    edited(file, "UPDATE accounts SET created_at = 'once'")
    assert damage_of(file) is None
    assert "accounts.created_at" in (damage_of(file, every_row=True) or "")


@pytest.mark.parametrize("trace", ["erasures.jsonl", "backups/1.reembody", "export/codebook.csv"])
def test_a_missing_database_is_said_where_there_was_one(tmp_path: Path, trace: str) -> None:
    """An unplugged disk or another folder must not look like a first start."""
    (tmp_path / trace).parent.mkdir(exist_ok=True)
    (tmp_path / trace).touch()
    settings = Settings(data_dir=tmp_path)
    with pytest.raises(Conflict, match=trace) as refused:
        prepare_database(settings, CLOCK)
    assert "--new-database" in refused.value.remedy
    assert not (tmp_path / "reembody.sqlite").exists()
    prepare_database(settings, CLOCK, new_database=True)
    prepare_database(settings, CLOCK)


def test_the_same_on_postgresql(tmp_path: Path) -> None:
    """An empty database on the server beside backups in the data folder."""
    (tmp_path / "erasures.jsonl").touch()
    with PostgresBench(running_cluster()).empty() as url:
        settings = Settings(data_dir=tmp_path, database_url=url)
        with pytest.raises(Conflict, match="has no Reembody database"):
            prepare_database(settings, CLOCK)
        prepare_database(settings, CLOCK, new_database=True)


def test_a_log_without_its_database_is_kept_from_the_new_one(tmp_path: Path) -> None:
    """SQLite would replay it into whatever file has that name."""
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


def test_a_database_that_was_begun_for_a_block_goes_if_it_fails(tmp_path: Path) -> None:
    """One that was there before stays."""
    settings = Settings(data_dir=tmp_path)
    with pytest.raises(NotADirectoryError), created_if_missing(settings, CLOCK):
        # It is there: what fails is that it is no folder.
        list((tmp_path / "reembody.sqlite").iterdir())
    assert list(tmp_path.iterdir()) == []
    prepare_database(settings, CLOCK)
    with pytest.raises(RuntimeError), created_if_missing(settings, CLOCK):
        raise RuntimeError
    assert (tmp_path / "reembody.sqlite").is_file()


def test_a_file_whose_log_was_not_copied_is_not_taken_for_whole(tmp_path: Path) -> None:
    """SQLite says nothing when that fails at the end: somebody who reads is enough."""
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
