"""The disk is full while headsets stream: acknowledgements stop, everybody is told, it goes on.

Fault 4 of the matrix. The short form takes the right to make files longer from the running server,
the long one fills a small disk.
"""

import asyncio
import os
import resource
import subprocess
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from tests.faults.outage import Outage
from tests.faults.outage_report import check_outage, check_recorded, outage_figures, reconciled
from tests.faults.streaming import pair_headsets
from tests.support.server import LiveServer

LIMIT_BYTES = 16 * 1024
DISK_MIB, ENOUGH_BYTES = 48, 256 * 1024


def test_a_server_that_may_not_write_says_so_and_goes_on_when_it_may(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """No file can grow (RLIMIT_FSIZE) for three seconds: nothing acknowledged is lost."""
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


@pytest.mark.long
@pytest.mark.timeout(600)
def test_a_full_disk_stops_acknowledgements_until_there_is_space(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A disk of 48 MiB without a free byte for 30 s; the warning of little space comes first."""
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
    """A disk in memory, mounted; skips where that is not permitted."""
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
    """Take what space is left but a little."""
    free = os.statvfs(ballast.parent)
    with ballast.open("wb") as file:
        os.posix_fallocate(file.fileno(), 0, free.f_bavail * free.f_frsize - ENOUGH_BYTES)
