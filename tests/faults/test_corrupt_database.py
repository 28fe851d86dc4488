"""A damaged database is put away, and a start without it is never taken for granted.

Fault 6 of the matrix, with the real server. How each kind of damage is noticed is tested in
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
"""As many pages in the log that several transactions lie behind the damaged one."""
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
    """The server's database."""
    return server.data_dir / "reembody.sqlite"


def garble(server: LiveServer) -> None:
    """The first bytes are somebody else's."""
    file_of(server).write_bytes(b"not a database, " + file_of(server).read_bytes()[16:])


def cut(server: LiveServer) -> None:
    """Half of it is missing."""
    file_of(server).write_bytes(file_of(server).read_bytes()[: 20 * PAGE])


def overwrite(server: LiveServer) -> None:
    """Some pages in the middle hold something else."""
    data = file_of(server).read_bytes()
    file_of(server).write_bytes(data[: 10 * PAGE] + b"\x07" * (8 * PAGE) + data[18 * PAGE :])


def damage_log(server: LiveServer) -> None:
    """One bit far back in the log."""
    flip(Path(f"{file_of(server)}-wal"), 3 * PAGE)


def checksums(folder: Path) -> dict[str, str]:
    """Of the database and its log, if there is anything in it."""
    return {
        path.name: hashlib.sha256(path.read_bytes()).hexdigest()
        for path in sorted(folder.glob("reembody.sqlite*"))
        if not path.name.endswith("-shm") and path.stat().st_size > 0
    }


def refusal(server: LiveServer) -> str:
    """What the server says instead of starting."""
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
def test_it_is_put_away_and_a_backup_brings_everything_back(
    tmp_path: Path, damage: Callable[[LiveServer], None], how_it_ends: str
) -> None:
    """Refused at every start until the backup is restored; what was found is kept as it was."""
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


def test_an_empty_database_is_begun_by_who_says_so(tmp_path: Path) -> None:
    """From then on every start is a plain one again."""
    server = LiveServer(tmp_path / "live").start()
    server.stop()
    garble(server)
    refusal(server)
    knowing = LiveServer(tmp_path / "live", command=KNOWINGLY)
    with knowing, knowing.client() as client:
        assert_signs_in(client)
    with server, server.client() as client:
        assert_signs_in(client)


def test_a_damaged_backup_helps_nobody_and_harms_nobody(tmp_path: Path) -> None:
    """It is refused before a database is begun."""
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


def test_a_torn_log_is_an_ordinary_start(tmp_path: Path) -> None:
    """What a power failure leaves is no damage."""
    server = LiveServer(tmp_path / "live").start()
    write_much(server)
    server.kill()
    log = Path(f"{file_of(server)}-wal")
    log.write_bytes(log.read_bytes()[:-1000])
    # What was never flushed was never noted there either.
    Path(f"{file_of(server)}-shm").unlink()
    with server, server.client() as client:
        assert_signs_in(client)
    assert not (server.data_dir / "quarantine").exists()


def test_a_newer_programs_database_is_refused_and_left_alone(tmp_path: Path) -> None:
    """The message names its schema and what to do."""
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
    """Some sign-ins, each a transaction, and more if the log has just been begun anew."""
    log = Path(f"{file_of(server)}-wal")
    with server.client() as client:
        for _ in range(5):
            assert_signs_in(client)
        while inspect_log(log).usable < FRAMES:
            assert_signs_in(client)


def assert_signs_in(client: httpx2.Client) -> None:
    """The first account is there."""
    credentials = {"username": "admin", "password": ADMIN_PASSWORD}
    assert client.post("/api/login", json=credentials).is_success
