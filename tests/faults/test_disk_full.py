"""Tests of a disk that is full while headsets stream: it is reported, and streaming recovers.

Fault 4 of the matrix. The short form denies the running server any growth of files, the long one
fills a small disk.
"""

import asyncio
import os
import resource
import subprocess
import sys
import time
import uuid
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

import httpx2
import pytest

from tests.faults.outage import Outage
from tests.faults.outage_report import check_outage, check_recorded, outage_figures, reconciled
from tests.faults.streaming import pair_headsets, signed_in
from tests.rehearsal.performed import STUDY
from tests.support.server import LiveServer

LIMIT_BYTES = 16 * 1024
DISK_MIB, ENOUGH_BYTES = 48, 256 * 1024
WAIT_S = 90.0


def test_a_server_that_cannot_write_reports_it_and_recovers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A server whose files cannot grow (RLIMIT_FSIZE) for 3 s loses nothing acknowledged."""
    with LiveServer(tmp_path / "live") as server:
        headsets = pair_headsets(server, 2)
        _, hard = resource.prlimit(server.pid, resource.RLIMIT_FSIZE)

        def limit(soft: int) -> None:
            resource.prlimit(server.pid, resource.RLIMIT_FSIZE, (soft, hard))

        outage = Outage(
            server,
            headsets,
            begin=lambda: limit(LIMIT_BYTES),
            end=lambda: limit(hard),
            lasts_s=3.0,
        )
        watch = asyncio.run(outage.run())
    found = reconciled(server, headsets)
    with capsys.disabled():
        sys.stdout.write(outage_figures("no file may grow", watch, found))
    check_outage(watch, found)
    check_recorded(server, headsets, watch.reason)


def test_operations_that_free_space_work_on_a_full_disk(tmp_path: Path) -> None:
    """On a completely full disk, operations that free space still work.

    Logging in, removing an export, ending a session and erasing all work, nothing new starts, and
    health recovers automatically once there is space.
    """
    folder = tmp_path / "live"
    server = LiveServer(folder, environment={"REEMBODY_LOW_DISK_BYTES": "0"})
    with small_disk(folder / "data") as disk, server, signed_in(server) as client:
        session, export = new_session(client), made_export(client)
        assert (disk / "reserve").stat().st_size >= 1024 * 1024
        ballast = disk / "ballast"
        fill_up(ballast)
        wait_for(lambda: command(client, session, "note").status_code == 503)
        assert health(client)["storage_reason"] == "the disk of the server is full"
        with signed_in(server) as other:
            fetched = other.get(f"/api/exports/{export}/file")
            assert fetched.is_success, fetched.text
            assert other.delete(f"/api/exports/{export}").status_code == 204
            for done in (command(other, session, "abort"), erased(other, session)):
                assert done.is_success, done.text
            joined = other.post(f"/api/studies/{STUDY}/sessions", json={"kind": "test"})
            assert joined.status_code == 503
        assert health(client)["storage"] == "failing"
        assert not (disk / "reserve").exists()
        ballast.unlink()
        wait_for(lambda: health(client)["storage"] == "ok")
        assert (disk / "reserve").exists()
        new_session(client)


def new_session(client: httpx2.Client) -> dict[str, Any]:
    """Create and start a session."""
    made = client.post(f"/api/studies/{STUDY}/sessions", json={"kind": "test"})
    made.raise_for_status()
    assert command(client, made.json(), "start").is_success
    session: dict[str, Any] = made.json()
    return session


def command(client: httpx2.Client, session: dict[str, Any], kind: str) -> httpx2.Response:
    """Send a command based on the current version of a session."""
    version = client.get(f"/api/sessions/{session['id']}").json()["version"]
    body = {"command_id": str(uuid.uuid4()), "expected_version": version, "type": kind}
    words = {"reason": "the disk is full", "text": "x" * 1500}
    return client.post(f"/api/sessions/{session['id']}/commands", json=body | words)


def erased(client: httpx2.Client, session: dict[str, Any]) -> httpx2.Response:
    """Request the erasure of a session's participant and return the response."""
    people = client.get(f"/api/studies/{STUDY}/participants").json()
    one = next(one for one in people if one["code"] == session["participant_code"])
    path = f"/api/studies/{STUDY}/participants/{one['id']}/erasure"
    return client.post(path, json={"confirm": one["code"], "reason_code": "requested"})


def made_export(client: httpx2.Client) -> str:
    """Create an export, wait until it is ready and return its id."""
    ordered = client.post(f"/api/studies/{STUDY}/exports", json={"kind": "test"}).json()
    path = f"/api/exports/{ordered['id']}"
    wait_for(lambda: client.get(path).json()["state"] == "ready")
    return str(ordered["id"])


def health(client: httpx2.Client) -> dict[str, Any]:
    """Return the health that the server reports."""
    told: dict[str, Any] = client.get("/api/health").json()
    return told


def wait_for(is_so: Callable[[], bool]) -> None:
    """Wait until the condition is true; fail after WAIT_S."""
    give_up_s = time.monotonic() + WAIT_S
    while not is_so():
        assert time.monotonic() < give_up_s
        time.sleep(0.05)


def fill_up(ballast: Path) -> None:
    """Use every free byte of the disk."""
    with ballast.open("wb", buffering=0) as file:
        for size in (1024 * 1024, 4096):
            with suppress(OSError):
                while True:
                    file.write(bytes(size))


@pytest.mark.long
@pytest.mark.timeout(600)
def test_a_full_disk_stops_acknowledgements_until_there_is_space(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A full disk of 48 MiB stops acknowledgements for 30 s, after a warning of low disk space."""
    folder = tmp_path / "live"
    with small_disk(folder / "data") as disk, LiveServer(folder) as server:
        with server.client() as client:
            assert client.get("/api/health").json()["low_disk"]
        headsets = pair_headsets(server, 3)
        ballast = disk / "ballast"
        outage = Outage(
            server, headsets, begin=lambda: fill(ballast), end=ballast.unlink, lasts_s=30.0
        )
        watch = asyncio.run(outage.run())
        server.stop()
        found = reconciled(server, headsets)
    with capsys.disabled():
        sys.stdout.write(outage_figures("full disk", watch, found))
    assert watch.reason == "the disk of the server is full"
    check_outage(watch, found)


@contextmanager
def small_disk(folder: Path) -> Iterator[Path]:
    """Mount a small disk in memory; skip the test if mounting is not permitted."""
    folder.mkdir(parents=True)
    options = f"size={DISK_MIB}m"
    command = ["mount", "-t", "tmpfs", "-o", options, "tmpfs", str(folder)]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        pytest.skip(f"no disk can be mounted here: {error}")
    if done.returncode != 0:
        pytest.skip(f"no disk can be mounted here: {done.stderr.strip()}")
    try:
        yield folder
    finally:
        subprocess.run(["umount", str(folder)], check=True)


def fill(ballast: Path) -> None:
    """Use nearly all free space of the disk."""
    free = os.statvfs(ballast.parent)
    with ballast.open("wb") as file:
        os.posix_fallocate(file.fileno(), 0, free.f_bavail * free.f_frsize - ENOUGH_BYTES)
