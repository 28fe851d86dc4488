"""Tests that telemetry waits and requests are rejected without loss while the database is locked.

Fault 5 of the matrix: a viewer or a backup that keeps a transaction open.
"""

import asyncio
import sqlite3
import sys
from contextlib import closing
from pathlib import Path

import pytest

from tests.faults.outage import Outage, Watch
from tests.faults.outage_report import check_outage, outage_figures, reconciled
from tests.faults.streaming import pair_headsets
from tests.support.server import LiveServer

LONGEST_WRITE_S = 5.0
"""The longest wait for the response that the database is locked, on a slow machine."""


@pytest.mark.parametrize(
    ("lock", "lasts_s"),
    [
        ("IMMEDIATE", 4.0),
        pytest.param("EXCLUSIVE", 30.0, marks=[pytest.mark.long, pytest.mark.timeout(600)]),
    ],
)
def test_a_locked_database_loses_nothing(
    tmp_path: Path, lock: str, lasts_s: float, capsys: pytest.CaptureFixture[str]
) -> None:
    """A locked database delays streams, a late headset and requests, and everything is stored."""
    with LiveServer(tmp_path / "live") as server:
        *headsets, latecomer = pair_headsets(server, 3)
        file = server.data_dir / "reembody.sqlite"
        with closing(sqlite3.connect(file, isolation_level=None)) as other:
            outage = Outage(
                server,
                headsets,
                begin=lambda: other.execute(f"BEGIN {lock}"),
                end=lambda: other.execute("ROLLBACK"),
                lasts_s=lasts_s,
                latecomer=latecomer,
            )
            watch = asyncio.run(outage.run())
    found = reconciled(server, [*headsets, latecomer])
    with capsys.disabled():
        sys.stdout.write(outage_figures(f"locked for {lasts_s:g} s", watch, found))
    check_outage(watch, found)
    check_waits(watch, lasts_s)


def check_waits(watch: Watch, lasts_s: float) -> None:
    """Assert that a headset's queue is bounded by the outage and that no request waits for long."""
    assert watch.reason == "another program has locked the database"
    # 2 streams of 15 messages a second, a report a second, and what was under way.
    assert watch.longest_queue <= (lasts_s + LONGEST_WRITE_S) * 31 + 31
    assert watch.longest_wait_s < LONGEST_WRITE_S
