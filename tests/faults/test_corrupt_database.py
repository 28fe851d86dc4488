"""Tests that a damaged database is quarantined and never silently replaced by an empty one.

Fault 6 of the matrix, with the real server. The detection of each kind of damage is tested in
tests/features/care/opening.
"""

import hashlib
import sqlite3
import sys
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

import httpx2
import pytest

from app.features.care.opening.wal import inspect_log
from tests.faults.commands import UNUSABLE, reembody
from tests.features.care.opening.files import flip
from tests.support.server import ADMIN_PASSWORD, LiveServer

PAGE = 4096
FRAMES = 35
"""Enough pages in the log for several transactions after the damaged one."""
KNOWINGLY = (
    sys.executable,
    "-c",
    """
import sys
from app.cli.serve.run import serve_forever
serve_forever({"port": int(sys.argv[3])}, new_database=True)
""",
)


def file_of(server: LiveServer) -> Path:
    """Return the path of the server's database."""
    return server.data_dir / "reembody.sqlite"


def garble(server: LiveServer) -> None:
    """Overwrite the first bytes of the database with other data."""
    file_of(server).write_bytes(b"not a database, " + file_of(server).read_bytes()[16:])


def cut(server: LiveServer) -> None:
    """Remove half of the database."""
    file_of(server).write_bytes(file_of(server).read_bytes()[: 20 * PAGE])


def overwrite(server: LiveServer) -> None:
    """Overwrite some pages in the middle of the database."""
    data = file_of(server).read_bytes()
    file_of(server).write_bytes(data[: 10 * PAGE] + b"\x07" * (8 * PAGE) + data[18 * PAGE :])


def damage_log(server: LiveServer) -> None:
    """Flip one early bit in the write-ahead log, with several transactions after it."""
    flip(Path(f"{file_of(server)}-wal"), 3 * PAGE)


def checksums(folder: Path) -> dict[str, str]:
    """Return the checksums of the database and of its log, if the log is not empty."""
    return {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.glob("reembody.sqlite*"))
        if not path.name.endswith("-shm") and path.stat().st_size > 0
    }


def refusal(server: LiveServer) -> str:
    """Return the message with which the server refuses to start."""
    before = len(server.log)
    with pytest.raises(RuntimeError, match="exit code 2"):
        server.start()
    said = server.log[before:]
    assert "Traceback" not in said
    return said


@pytest.mark.parametrize(
    ("damage", "how_it_ends"),
    [
        pytest.param(garble, "stop", marks=pytest.mark.long),
        pytest.param(cut, "stop", marks=pytest.mark.long),
        (overwrite, "stop"),
        (damage_log, "kill"),
    ],
)
def test_a_damaged_database_is_quarantined_and_restored(
    tmp_path: Path, damage: Callable[[LiveServer], None], how_it_ends: str
) -> None:
    """A damaged database is quarantined unchanged, and a restored backup replaces it."""
    server = LiveServer(tmp_path / "live").start()
    made = reembody(server, "backup", tmp_path / "all.reembody", "--json").json
    write_much(server)
    getattr(server, how_it_ends)()
    damage(server)
    before = checksums(server.data_dir)
    said = refusal(server)
    (place,) = (server.data_dir / "quarantine").iterdir()
    assert str(place) in said
    assert "./run restore FILE" in said
    assert checksums(place) == before
    assert not file_of(server).exists()
    assert "the earlier database is damaged" in refusal(server)
    assert not file_of(server).exists()
    restored = reembody(server, "restore", tmp_path / "all.reembody", "--json").json
    assert restored["sha256"] == made["sha256"]
    with server, server.client() as client:
        assert_signs_in(client)
    assert checksums(place) == before


def test_a_new_database_is_created_only_on_request(tmp_path: Path) -> None:
    """An operator may explicitly create a new database; later starts then need no option."""
    server = LiveServer(tmp_path / "live").start()
    server.stop()
    garble(server)
    refusal(server)
    knowing = LiveServer(tmp_path / "live", command=KNOWINGLY)
    with knowing, knowing.client() as client:
        assert_signs_in(client)
    with server, server.client() as client:
        assert_signs_in(client)


def test_a_damaged_backup_is_rejected(tmp_path: Path) -> None:
    """A damaged backup is rejected before a database is created."""
    server = LiveServer(tmp_path / "live").start()
    reembody(server, "backup", tmp_path / "all.reembody")
    server.stop()
    backup = tmp_path / "all.reembody"
    backup.write_bytes(backup.read_bytes()[:-PAGE])
    garble(server)
    refusal(server)
    said = reembody(server, "restore", backup)
    assert said.code == UNUSABLE
    assert "not a complete Reembody backup" in said.err
    assert not file_of(server).exists()


def test_a_torn_log_is_not_damage(tmp_path: Path) -> None:
    """A write-ahead log torn by a power failure is not treated as damage."""
    server = LiveServer(tmp_path / "live").start()
    write_much(server)
    server.kill()
    log = Path(f"{file_of(server)}-wal")
    log.write_bytes(log.read_bytes()[:-1000])
    # The index never referred to data that were not flushed.
    Path(f"{file_of(server)}-shm").unlink()
    with server, server.client() as client:
        assert_signs_in(client)
    assert not (server.data_dir / "quarantine").exists()


def test_a_newer_programs_database_is_refused_unchanged(tmp_path: Path) -> None:
    """A database of a newer program is refused unchanged, with its schema and the remedy."""
    server = LiveServer(tmp_path / "live").start()
    server.stop()
    with closing(sqlite3.connect(file_of(server))) as connection:
        connection.execute("UPDATE alembic_version SET version_num = '9999'")
        connection.commit()
    before = checksums(server.data_dir)
    said = refusal(server)
    assert "schema 9999" in said
    assert "Start the newer version" in said
    assert checksums(server.data_dir) == before


def write_much(server: LiveServer) -> None:
    """Sign in several times, each a transaction, until the log is long enough."""
    log = Path(f"{file_of(server)}-wal")
    with server.client() as client:
        for _ in range(5):
            assert_signs_in(client)
        while inspect_log(log).usable < FRAMES:
            assert_signs_in(client)


def assert_signs_in(client: httpx2.Client) -> None:
    """Assert that the first account exists and can sign in."""
    credentials = {"username": "admin", "password": ADMIN_PASSWORD}
    assert client.post("/api/login", json=credentials).is_success
