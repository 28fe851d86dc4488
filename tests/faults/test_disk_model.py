"""Tests of the emulated disk and of the tracer, on files small enough to follow by hand."""

import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from tests.faults.power.disk import MOODS, Disk, replay, timeline
from tests.faults.power.promises import promises_of
from tests.faults.tracing.events import NEVER, Event, read_events
from tests.faults.tracing.running import RECORD, REPOSITORY, traced, why_not

FOLDER, FILE = "/d", "/d/a"
PROGRAM = """
import os, socket, sys, threading
os.chdir(sys.argv[1])
def work(name):
    file = os.open(name, os.O_RDWR | os.O_CREAT)
    os.write(file, b"first")
    os.pwrite(file, b"second" * 2000, 3)
    os.writev(file, [b"x", b"", b"yz"])
    os.fsync(file)
    os.ftruncate(file, 9000)
    os.pwrite(file, b"late", 20000)
    os.close(file)
threads = [threading.Thread(target=work, args=(f"file{n}",)) for n in range(3)]
[thread.start() for thread in threads]
[thread.join() for thread in threads]
if os.fork() == 0:
    work("child")
    os._exit(0)
os.wait()
os.rename("file0", "renamed")
os.unlink("file1")
one, other = socket.socketpair()
one.send(b"told")
other.sendmsg([b"to", b"ld"])
os.write(one.fileno(), b"again")
"""


def event(what: str, stamp: int, data: bytes = b"", *, offset: int = 0, path: str = FILE) -> Event:
    """Return the event of a call that returns before the next call begins."""
    return Event(what, what, path, 2 * stamp, 2 * stamp + 1, 0, 0, offset=offset, data=data)


def disk_after(events: Sequence[Event], until: int = NEVER - 1) -> Disk:
    """Return the disk after all calls up to a stamp have begun or returned."""
    disk = Disk(FOLDER)
    replay(disk, (moment for moment in timeline(events) if moment[0] <= until))
    return disk


@pytest.fixture
def started() -> list[Event]:
    """Provide the calls that write a file of three sectors of ones and make it certain."""
    return [
        event("create", 1),
        event("write", 2, b"1" * 1536),
        event("sync", 3),
        event("sync", 4, path=FOLDER),
    ]


def test_synced_data_survive_in_every_mood(started: list[Event]) -> None:
    """Synced data exist in every mood of the disk; a name exists only if its folder was synced."""
    rng = np.random.default_rng(1)
    for mood in MOODS:
        assert disk_after(started).after_power_loss(rng, mood) == {"a": b"1" * 1536}
    unnamed = disk_after(started[:3])
    assert unnamed.after_power_loss(rng, "nothing") == {}
    assert unnamed.after_power_loss(rng, "everything") == {"a": b"1" * 1536}


def test_every_sector_has_one_of_its_versions_in_all_mixtures(started: list[Event]) -> None:
    """After two writes, each of three sectors has one of its versions, and all mixtures occur."""
    disk = disk_after(
        [*started, event("write", 5, b"2" * 1536), event("write", 6, b"3" * 600, offset=300)]
    )
    rng = np.random.default_rng(1)
    of_sector: list[set[bytes]] = [
        {b"1" * 512, b"2" * 512, b"2" * 300 + b"3" * 212},
        {b"1" * 512, b"2" * 512, b"3" * 388 + b"2" * 124},
        {b"1" * 512, b"2" * 512},
    ]
    seen: set[tuple[bytes, ...]] = set()
    for _ in range(1000):
        content = disk.after_power_loss(rng, "scattered")["a"]
        seen.add(tuple(content[at : at + 512] for at in (0, 512, 1024)))
    assert len(seen) == 3 * 3 * 2
    for mixture in seen:
        assert all(piece in possible for piece, possible in zip(mixture, of_sector, strict=True))


def test_a_sync_covers_only_what_had_returned_before_it_began(started: list[Event]) -> None:
    """A sync does not cover another thread's write that had not returned when the sync began."""
    overlapping = replace(event("write", 5, b"2" * 512), ended=13)
    disk = disk_after([*started, overlapping, event("sync", 6)])
    assert disk.certain()["a"] == b"1" * 1536
    again = disk_after([*started, overlapping, event("sync", 6), event("sync", 7)])
    assert again.certain()["a"] == b"2" * 512 + b"1" * 1024


def test_a_file_has_one_of_its_sizes(started: list[Event]) -> None:
    """A truncated and extended file has one of its sizes; unwritten parts are zeros or noise."""
    cut = replace(event("truncate", 5), size=512)
    disk = disk_after([*started, cut, event("write", 6, b"2" * 512, offset=1024)])
    rng = np.random.default_rng(1)
    sizes = {len(disk.after_power_loss(rng, "scattered")["a"]) for _ in range(200)}
    assert sizes == {512, 1536}
    latest = disk.after_power_loss(rng, "everything")["a"]
    assert latest == b"1" * 512 + bytes(512) + b"2" * 512


def test_a_removed_file_may_reappear_until_its_folder_is_synced(started: list[Event]) -> None:
    """A removed file, such as SQLite's log, may reappear until its folder is synced."""
    gone = [*started, event("unlink", 5)]
    rng = np.random.default_rng(1)
    found = [disk_after(gone).after_power_loss(rng, "scattered") for _ in range(50)]
    assert {} in found
    assert {"a": b"1" * 1536} in found
    assert disk_after([*gone, event("sync", 6, path=FOLDER)]).certain() == {}


def test_the_tracer_sees_every_change_of_every_thread_and_process(tmp_path: Path) -> None:
    """Replaying a trace of threads and a child process reproduces the files that they left."""
    folder = tmp_path / "data"
    folder.mkdir()
    skip_without_tracing(tmp_path)
    command = traced(tmp_path / RECORD, folder, [sys.executable, "-c", PROGRAM, str(folder)])
    subprocess.run(command, check=True, cwd=REPOSITORY, timeout=60)
    events = read_events(tmp_path / RECORD)
    disk = Disk(str(folder.resolve()))
    replay(disk, timeline(events))
    left = {path.name: path.read_bytes() for path in folder.iterdir()}
    assert set(left) == {"renamed", "file2", "child"}
    assert disk.after_power_loss(np.random.default_rng(1), "everything") == left
    assert [one.data for one in events if one.what == "send"][-3:] == [b"told", b"told", b"again"]
    assert [one.ended for one in events if one.ended == NEVER] == []


def test_the_tracer_returns_the_exit_code(tmp_path: Path) -> None:
    """The tracer returns the exit code of a command that failed or was killed."""
    skip_without_tracing(tmp_path)
    for script, code in (("exit 3", 3), ("kill -9 $$", 128 + 9)):
        command = traced(tmp_path / RECORD, tmp_path, ["sh", "-c", script])
        assert subprocess.run(command, check=False, cwd=REPOSITORY, timeout=60).returncode == code


def test_promises_are_read_from_bytes_in_any_pieces() -> None:
    """An acknowledgement, sent whole or in pieces, is made when its last byte is sent."""
    head = b"HTTP/1.1 101 Switching Protocols\r\nupgrade: websocket\r\n\r\n"
    welcome = b'{"type": "welcome", "session_id": "s", "positions": []}'
    ack = b'{"type":"ack","positions":[{"stream":"target","epoch":1,"next_seq":%06d}]}' % 12
    ack = ack.replace(b"000012", b"12    ") + b" " * 100
    text = bytes([0x81, len(welcome)]) + welcome + b"\x89\x01p"
    long = bytes([0x81, 126]) + len(ack).to_bytes(2, "big") + ack
    told = head + text + long
    for size in (1, 7, len(told)):
        sends = [
            event("send", 1 + at, told[at : at + size], path="socket:[1]")
            for at in range(0, len(told), size)
        ]
        (first, second) = promises_of(sends)
        assert first.session_id == "s"
        assert (second.is_ack, dict(second.positions)) == (True, {("s", "target", 1): 12})
        assert second.began == sends[-1].began


def skip_without_tracing(folder: Path) -> None:
    """Skip the test if the kernel does not allow tracing."""
    reason = why_not(folder)
    if reason is not None:
        pytest.skip(reason)
