"""Tests of data ownership: one process at a time, the lock, and the reported owner."""

import os
import shutil
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from sqlalchemy import text

from app.clock import Clock
from app.database_address import disconnect, open_connection
from app.errors import Conflict, NotDurable, NotNow
from app.features.care.opening import existing_database
from app.features.care.ownership import Owned, Ownership, OwnerWatch, own_data
from app.features.care.ownership.folder_lock import NAME, FolderLock
from app.features.care.ownership.owner import Owner
from app.features.care.ownership.service import prepared_beside_owner
from app.platform.background import Background
from app.settings import Settings
from tests.support.sqlite import fresh_sqlite

HOLDER = """
import sys, time
from pathlib import Path
from app.features.care.ownership import own_data
from app.settings import Settings
own = own_data(Settings(data_dir=Path(sys.argv[1]), database_url=sys.argv[2]), port=4711)
{more}
print("holds", flush=True)
time.sleep(600)
"""
FORKS = """
import os
worker = os.fork()
if worker == 0:
    time.sleep(600)
    os._exit(0)
print("worker", worker, flush=True)
"""
SPAWNS = """
import subprocess
worker = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
print("worker", worker.pid, flush=True)
"""


@contextmanager
def holder(settings: Settings, more: str = "") -> Iterator[tuple[int, list[int]]]:
    """Run another process that owns the data; yield its process id and those of its workers."""
    arguments = [str(settings.data_dir), settings.database_url]
    process = subprocess.Popen(
        [sys.executable, "-c", HOLDER.format(more=more), *arguments],
        stdout=subprocess.PIPE,
        text=True,
    )
    workers: list[int] = []
    try:
        assert process.stdout is not None
        while (line := process.stdout.readline().split()) != ["holds"]:
            assert line, "it ended"
            workers.append(int(line[1]))
        yield process.pid, workers
    finally:
        for worker in workers:
            os.kill(worker, signal.SIGKILL)
        process.kill()
        process.wait()
        if process.stdout is not None:
            process.stdout.close()


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    """Return the settings of a data folder that no process owns."""
    return Settings(data_dir=tmp_path / "data")


def test_a_second_owner_is_refused_with_details_of_the_first(settings: Settings) -> None:
    """A second owner is refused with the first one's process, port, machine and start time.

    It succeeds once the first has released the data; a folder created only for the lock is removed.
    """
    with own_data(settings, port=8321), pytest.raises(Owned) as refused:
        own_data(settings, port=8400)
    message = refused.value.message
    assert f"the server with the process id {os.getpid()} on port 8321" in message
    assert os.uname().nodename in message
    assert "since 20" in message
    assert "nothing was changed" in message
    assert "REEMBODY_DATA_DIR" in refused.value.remedy
    with own_data(settings) as own:
        assert own.owner.port is None
        assert [path.name for path in settings.data_dir.iterdir()] == [NAME]
    assert not settings.data_dir.exists()


@pytest.mark.parametrize("more", ["", FORKS, SPAWNS])
def test_a_killed_owners_lock_is_free_although_its_worker_lives(
    settings: Settings, more: str
) -> None:
    """A killed owner's lock is free even if a forked or spawned worker of it still runs."""
    with holder(settings, more) as (pid, workers):
        with pytest.raises(Owned, match=f"process id {pid} on port 4711"):
            own_data(settings)
        os.kill(pid, signal.SIGKILL)
        _wait_for_end(pid)
        assert all(_lives(worker) for worker in workers)
        with own_data(settings):
            pass


@pytest.mark.parametrize("more", [FORKS, SPAWNS])
def test_an_owner_keeps_its_lock_when_a_worker_ends(settings: Settings, more: str) -> None:
    """An owner keeps its lock when a forked or spawned worker of it ends."""
    with holder(settings, more) as (_, workers):
        os.kill(workers.pop(), signal.SIGKILL)
        with pytest.raises(Owned):
            own_data(settings)


def test_every_path_to_the_data_leads_to_one_lock(tmp_path: Path, settings: Settings) -> None:
    """A data folder has only one lock, by whatever link or path it or its database is opened."""
    settings.data_dir.mkdir()
    (tmp_path / "link").symlink_to(settings.data_dir)
    (settings.data_dir / "reembody.sqlite").touch()
    other = tmp_path / "other"
    other.mkdir()
    (other / "linked.sqlite").symlink_to(settings.data_dir / "reembody.sqlite")
    with own_data(settings):
        for same in (
            Settings(data_dir=tmp_path / "link"),
            Settings(data_dir=tmp_path / "other" / ".." / "data"),
            Settings(data_dir=other, database_url=f"sqlite:///{tmp_path}/data/reembody.sqlite"),
            Settings(data_dir=other, database_url=f"sqlite:///{other}/linked.sqlite"),
            # The folder alone is enough: its exports and fits belong to the owner.
            Settings(data_dir=tmp_path / "data", database_url=f"sqlite:///{other}/own.sqlite"),
        ):
            with pytest.raises(Owned):
                own_data(same)
        # A refused owner releases the locks that it already had.
        with own_data(Settings(data_dir=other)):
            pass


@pytest.mark.parametrize("suffix", ["", "-wal", "-shm"])
@pytest.mark.parametrize("opened", ["by its name", "by a symbolic link"])
def test_a_database_with_a_second_hard_link_is_refused(
    tmp_path: Path, settings: Settings, suffix: str, opened: str
) -> None:
    """A database file with a second hard link is refused, also when opened by a symbolic link.

    The same holds for its `-wal` and `-shm` files. The error gives the other path, no lock is
    created, and a copy in place of the second link is accepted.
    """
    settings.data_dir.mkdir()
    other = tmp_path / "other"
    other.mkdir()
    database = settings.data_dir / "reembody.sqlite"
    first, second = (one / f"reembody.sqlite{suffix}" for one in (settings.data_dir, other))
    database.touch()
    first.touch()
    os.link(first, second)
    (tmp_path / "link").symlink_to(database)
    if opened == "by a symbolic link":
        settings = Settings(data_dir=other, database_url=f"sqlite:///{tmp_path / 'link'}")
    with pytest.raises(Conflict, match="has 2 names") as refused:
        own_data(settings)
    assert f"{first} has 2 names (hard links), one of which is {second}." in str(refused.value)
    assert "`cp -a`" in refused.value.remedy
    with pytest.raises(Conflict, match="has 2 names"):
        existing_database(settings)
    assert not list(tmp_path.rglob(NAME))
    shutil.copy(second, tmp_path / "copy")
    (tmp_path / "copy").rename(second)
    with own_data(settings):
        pass


def test_distant_hard_links_are_only_counted(tmp_path: Path, settings: Settings) -> None:
    """Hard links far from the data folder are counted, and the error says how to find them."""
    settings.data_dir.mkdir()
    file = settings.data_dir / "reembody.sqlite"
    file.touch()
    far = tmp_path / "a" / "b" / "c"
    far.mkdir(parents=True)
    os.link(file, far / "other")
    with pytest.raises(Conflict, match=r"has 2 names \(hard links\)\. ") as refused:
        own_data(settings)
    assert f"-inum {file.stat().st_ino}" in refused.value.remedy


def test_an_owner_waits_for_a_command_but_not_for_a_server(settings: Settings) -> None:
    """A new owner waits for a command that has the lock, but not for a server."""
    first = own_data(settings, "verify")
    threading.Timer(0.3, first.release).start()
    with own_data(settings):
        began_s = time.monotonic()
        with pytest.raises(Owned):
            own_data(settings, "verify")
        assert time.monotonic() - began_s < 2.0


def test_a_removed_lock_file_is_recreated(settings: Settings) -> None:
    """An owner whose lock file was removed recreates and locks it at its next check."""
    background = Background(Clock())
    with own_data(settings) as own:
        watch = OwnerWatch(own, background, _never)
        (settings.data_dir / NAME).unlink()
        watch.look()
        with pytest.raises(Owned):
            own_data(settings)
    assert background.failing() == ()


def test_an_owner_that_lost_its_data_shuts_down(settings: Settings) -> None:
    """A server whose data another process took over reports this in its health and shuts down."""
    background, ended = Background(Clock()), []
    with own_data(settings) as own:
        watch = OwnerWatch(own, background, lambda: ended.append(True))
        (settings.data_dir / NAME).unlink()
        with own_data(settings):
            watch.look()
    assert ended == [True]
    assert [one.name for one in background.failing()] == ["owner"]


def test_a_lock_without_its_text_still_counts(settings: Settings) -> None:
    """A second owner is refused even if the lock file has no text, as after a full disk."""
    settings.data_dir.mkdir()
    owner = Owner.myself("serve", 1)
    folder_lock = FolderLock(settings.data_dir, owner)
    (settings.data_dir / NAME).write_text("")
    with pytest.raises(Owned, match="in use by another process of Reembody"):
        own_data(settings)
    folder_lock.release()


def test_a_data_folder_that_is_a_file_is_refused(tmp_path: Path) -> None:
    """A data folder whose path is a file is refused with a readable error."""
    (tmp_path / "file").touch()
    with pytest.raises(NotDurable, match="cannot be locked"):
        own_data(Settings(data_dir=tmp_path / "file"))


def test_a_reader_works_alongside_an_owner_that_has_prepared(tmp_path: Path) -> None:
    """A reading command works alongside an owner that has prepared the database.

    Without an owner, the command prepares the database itself; while an owner is still preparing
    it, the command is refused.
    """
    settings, prepared = Settings(data_dir=tmp_path), []

    def read() -> None:
        with prepared_beside_owner(settings, "verify", lambda: prepared.append(True)):
            pass

    read()
    assert prepared == [True]
    with own_data(settings):
        with pytest.raises(NotNow, match="works with it"):
            read()
        fresh_sqlite(tmp_path / "reembody.sqlite")
        read()
    assert prepared == [True]


def test_a_postgres_database_has_one_owner_whatever_the_folder(
    tmp_path: Path, postgres_url: str
) -> None:
    """A PostgreSQL database has one owner until that is killed, whatever the data folders."""
    first = Settings(data_dir=tmp_path / "a", database_url=postgres_url)
    second = Settings(data_dir=tmp_path / "b", database_url=postgres_url)
    with holder(first) as (pid, _):
        with pytest.raises(Owned, match=f"process id {pid} on port 4711") as refused:
            own_data(second)
        assert os.uname().nodename[:10] in refused.value.message
        os.kill(pid, signal.SIGKILL)
        _wait_for_end(pid)
        with own_data(second):
            pass


def test_a_lost_postgres_lock_is_retaken_or_given_up(tmp_path: Path, postgres_url: str) -> None:
    """A server that lost its PostgreSQL lock reacquires it, or shuts down if another has it."""
    background, ended = Background(Clock()), []
    own = own_data(Settings(data_dir=tmp_path / "a", database_url=postgres_url))
    other = Settings(data_dir=tmp_path / "b", database_url=postgres_url)
    watch = OwnerWatch(own, background, lambda: ended.append(True))
    _end_connections_of(postgres_url, own)
    watch.look()
    with pytest.raises(Owned):
        own_data(other)
    assert (background.failing(), ended) == ((), [])
    _end_connections_of(postgres_url, own)
    with own_data(other):
        watch.look()
    assert [one.urgency for one in background.failing()] == ["warning"]
    assert ended == [True]
    own.release()


def _end_connections_of(url: str, own: Ownership) -> None:
    connection = open_connection(url)
    try:
        query = (
            "SELECT count(pg_terminate_backend(pid)) FROM pg_stat_activity "
            "WHERE application_name LIKE :name AND datname = current_database()"
        )
        name = f"reembody serve {own.owner.pid} %"
        assert connection.execute(text(query), {"name": name}).scalar() == 1
    finally:
        disconnect(connection)
    time.sleep(0.2)


def _never() -> None:
    pytest.fail("the owner was asked to shut down")


def _lives(pid: int) -> bool:
    return Path(f"/proc/{pid}").exists()


def _wait_for_end(pid: int) -> None:
    give_up_s = time.monotonic() + 10.0
    while time.monotonic() < give_up_s:
        process = Path(f"/proc/{pid}")
        # Its first thread may end before the others, which still hold its files open.
        if not process.exists() or (
            "State:\tZ" in (process / "status").read_text()
            and len(list((process / "task").iterdir())) == 1
        ):
            return
        time.sleep(0.01)
    pytest.fail(f"process {pid} does not end")
