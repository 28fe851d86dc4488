"""Tests of the data folder's permissions, and of its traces of an earlier database."""

import os
import stat
from pathlib import Path

import pytest

from app.platform.folders import is_there, protect, traces_of_a_database
from app.settings import Settings


def mode(path: Path) -> int:
    """Return the permission bits of a path."""
    return stat.S_IMODE(os.lstat(path).st_mode)


@pytest.fixture
def data(tmp_path: Path) -> Path:
    """Return a data folder as an earlier version left it, readable by everyone."""
    data = tmp_path / "data"
    for name in ("reembody.sqlite", "reembody.sqlite-wal", "backups/1.reembody", "tls/key.pem"):
        (data / name).parent.mkdir(parents=True, exist_ok=True)
        (data / name).write_text("secret")
        (data / name).chmod(0o644)
    for folder in (data, data / "backups", data / "tls"):
        folder.chmod(0o755)
    return data


def test_protecting_removes_access_for_others(data: Path) -> None:
    """Protecting the data folder makes its files and folders private to their owner."""
    settings = Settings(data_dir=data)
    for _ in range(2):
        assert protect(settings) == []
        assert {mode(path) for path in data.rglob("*") if path.is_file()} == {0o600}
        assert {mode(path) for path in (data, data / "backups", data / "tls")} == {0o700}


def test_protecting_does_not_follow_links(data: Path, tmp_path: Path) -> None:
    """Protecting the data folder does not change what its links point to."""
    outside = tmp_path / "outside"
    outside.mkdir()
    outside.chmod(0o755)  # independent of the umask of an earlier command
    (outside / "mine.txt").write_text("mine")
    (outside / "mine.txt").chmod(0o644)
    (data / "backups" / "link.txt").symlink_to(outside / "mine.txt")
    (data / "quarantine").symlink_to(outside)
    protect(Settings(data_dir=data))
    assert (mode(outside), mode(outside / "mine.txt")) == (0o755, 0o644)


def test_a_world_writable_data_folder_keeps_its_mode(data: Path) -> None:
    """A world-writable data folder keeps its mode, but the database's files become private."""
    data.chmod(0o1777)
    protect(Settings(data_dir=data))
    assert mode(data) == 0o1777
    assert mode(data / "reembody.sqlite") == 0o600


def test_other_files_in_a_shared_folder_are_unchanged(data: Path, tmp_path: Path) -> None:
    """If the database is in a shared folder, only its own file becomes private."""
    file = tmp_path / "shared" / "lab.sqlite"
    file.parent.mkdir()
    file.parent.chmod(0o755)
    for path in (file, file.parent / "notes.txt"):
        path.write_text("x")
        path.chmod(0o644)
    protect(Settings(data_dir=data, database_url=f"sqlite:///{file}"))
    assert (mode(file), mode(file.parent / "notes.txt"), mode(file.parent)) == (0o600, 0o644, 0o755)


def test_a_new_folder_has_no_traces(tmp_path: Path) -> None:
    """A missing or new data folder has no traces of a database."""
    settings = Settings(data_dir=tmp_path / "data")
    assert traces_of_a_database(settings) == []
    for name in ("tls/authority.pem", "lost+found/x", ".lock", "server.log", "scratch/uploads/x"):
        (tmp_path / "data" / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / "data" / name).touch()
    assert traces_of_a_database(settings) == []


@pytest.mark.parametrize(
    "name",
    [
        "backups/before-restore-1.reembody",
        "2026-11-21.reembody",
        "quarantine/20261121T061108.123456Z",
        "erasures.jsonl",
        "erasure-unfinished",
        "walking/0f3a",
        "scratch/exports/1.zip",
        "export/codebook.csv",
        "tuned.yaml",
        "reembody.sqlite-wal",
    ],
)
def test_files_of_a_database_are_traces_of_it(tmp_path: Path, name: str) -> None:
    """Backups, exports, erasures, fits, tuned avatars and logs are traces of a database."""
    (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
    (tmp_path / name).touch()
    assert traces_of_a_database(Settings(data_dir=tmp_path)) == [name]


def test_a_dangling_link_counts_as_a_database(tmp_path: Path) -> None:
    """A dangling link in place of the database counts as an existing database."""
    file = tmp_path / "reembody.sqlite"
    assert not is_there(file)
    file.symlink_to(tmp_path / "unplugged" / "reembody.sqlite")
    assert is_there(file)
