"""Tests that every session is completed although the server is killed in every kind of step.

Fault 1 of the matrix: nothing that was acknowledged is lost, and the same phase continues with the
active time it had.
"""

import asyncio
import sys
from pathlib import Path

import numpy as np
import pytest

from app.features.record.sessions import events_of, verify_chain
from app.rehearsal.cast import perform
from app.rehearsal.rehearse import RehearsalPlan, assembled
from tests.faults.figures import note
from tests.faults.killer import Kill, Killer, figures
from tests.faults.record import record_of
from tests.faults.schedule import KILLS_PER_SESSION, KINDS, draw_schedule
from tests.rehearsal.ledger import LedgerJournal, Reconciliation, reconcile
from tests.rehearsal.performed import SHIPPED, Lengths
from tests.support.server import ADMIN_PASSWORD, LiveServer

FRAME_S = 1 / 90
SHORT_KILLS = 6
SPEED = 20.0
SHORT_SPEED = 10.0
# Each lasts a second of real time: longer than the longest wait before a kill.
SHORT = Lengths(15.0, 10.0, 2.5)


@pytest.mark.timeout(900)
def test_kills_lose_nothing_and_every_phase_continues(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """A session whose server is killed from set-up to the last phase completes without loss."""
    kills = kill_until(tmp_path, SHORT_KILLS, SHORT, SHORT_SPEED, first_seed=1, capsys=capsys)
    assert {"setup", "preparing", "running"} <= {kill.before.kind for kill in kills}


@pytest.mark.long
@pytest.mark.timeout(3600)
def test_two_hundred_kills_lose_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Two hundred kills in sessions of the shipped length lose nothing that was acknowledged."""
    kills = kill_until(
        tmp_path, 10 * KILLS_PER_SESSION, SHIPPED, SPEED, first_seed=2, capsys=capsys
    )
    assert set(KINDS) <= {kill.before.kind for kill in kills}


def kill_until(
    folder: Path,
    wanted: int,
    lengths: Lengths,
    speed: float,
    *,
    first_seed: int,
    capsys: pytest.CaptureFixture[str],
) -> list[Kill]:
    """Rehearse whole sessions until there were `wanted` kills, and check each of them."""
    kills: list[Kill] = []
    seed = first_seed
    while len(kills) < wanted:
        kills += _kill_during_a_session(
            folder / str(seed), lengths, speed, seed, wanted - len(kills)
        )
        seed += 1
    note(
        1,
        f"server killed ({len(kills)} times)",
        "acknowledged and lost",
        sum(k.lost for k in kills),
    )
    note(1, f"server killed ({len(kills)} times)", "stored twice", sum(k.surplus for k in kills))
    times_s = [kill.recovery_s for kill in kills]
    note(
        1,
        f"server killed ({len(kills)} times)",
        "recovery p95 (s)",
        float(np.percentile(times_s, 95)),
    )
    with capsys.disabled():
        sys.stdout.write(figures(kills))
    return kills


def _kill_during_a_session(
    folder: Path, lengths: Lengths, speed: float, seed: int, most: int
) -> list[Kill]:
    ledger = LedgerJournal()
    with LiveServer(folder) as server:
        plan = RehearsalPlan(
            server.url, lengths.store(server), speed=speed, seed=seed, password=ADMIN_PASSWORD
        )
        kills, session_id = asyncio.run(_rehearse(server, plan, ledger, most))
        for kill in kills:
            check_kill(kill)
        check_session(server, session_id, ledger, lengths)
    return kills


async def _rehearse(
    server: LiveServer, plan: RehearsalPlan, ledger: LedgerJournal, most: int
) -> tuple[list[Kill], str]:
    targets = draw_schedule(np.random.default_rng(plan.seed))
    if most < KILLS_PER_SESSION:
        targets = targets[:: max(1, len(targets) // (most + 1))]
    async with assembled(plan, journal=ledger) as cast:
        killer = Killer(server, cast, ledger)
        async with asyncio.TaskGroup() as group:
            group.create_task(perform(cast))
            group.create_task(killer.run(targets, min(most, KILLS_PER_SESSION)))
        return killer.kills, cast.operator.session_id


def check_kill(kill: Kill) -> None:
    """Assert that acknowledged data are stored once and that the session resumes where it was."""
    assert (kill.lost, kill.surplus) == (0, 0), kill
    before, after = kill.before, kill.after
    assert after.version >= before.version, kill
    assert all(after.stored[key] >= seq for key, seq in before.stored.items()), kill
    assert (after.step or 0) >= (before.step or 0), kill
    if before.phase_id is not None and after.phase_id == before.phase_id:
        assert kill.acked_active_s - 1e-9 <= after.active_s <= kill.used_active_s + 1e-9, kill


def check_session(
    server: LiveServer, session_id: str, ledger: LedgerJournal, lengths: Lengths
) -> None:
    """Assert that the session was completed as if no kill had happened."""
    with record_of(server) as db:
        found = reconcile(db, session_id, ledger)
        rows = events_of(db, session_id)
    assert found.sound
    assert found == Reconciliation(found.sent, found.sent, found.sent, 0, 0, 0, 0)
    assert verify_chain(rows).ok
    with server.client() as client:
        signed_in = {"username": "admin", "password": ADMIN_PASSWORD}
        assert client.post("/api/login", json=signed_in).is_success
        view = client.get(f"/api/sessions/{session_id}").json()
        answers = client.get(f"/api/sessions/{session_id}/answers").json()
    assert view["status"] == "completed"
    # No step was repeated or skipped, and each form is stored once.
    assert {(step["status"], step["attempt"]) for step in view["steps"]} == {("done", 1)}
    assert len({row["administration"] for row in answers}) == len(answers) == 7
    phases = view["phases"]
    assert {phase["status"] for phase in phases} == {"done"}
    assert [phase["active_s"] for phase in phases] == pytest.approx(
        [lengths.roam_s] + [lengths.task_s] * 6, abs=FRAME_S
    )
