"""Tests that sessions continue without loss when connections break or devices restart mid-phase."""

import asyncio
from collections.abc import Callable, Coroutine
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from sqlalchemy import func, select

from app.client.http import call
from app.client.telemetry import TelemetryClient
from app.features.record.telemetry.frames import phase_frames
from app.models import ClientReport
from app.rehearsal.answers import fill_in
from app.rehearsal.cast import Cast, answer, operate
from app.rehearsal.frame_clock import FrameClock
from app.rehearsal.headset import FRAMES_PER_BATCH, MESSAGES_AHEAD, Headset
from app.rehearsal.rehearse import RehearsalPlan, assembled, tasks_of
from app.simulated_people.body import make_person
from app.wire import StreamName
from tests.faults.record import record_of
from tests.faults.relay import Relay, relayed
from tests.faults.short_study import PHASE_S, ROAM_S, TASKS, Watch, add_short_study
from tests.rehearsal.ledger import LedgerJournal, reconcile
from tests.support.server import ADMIN_PASSWORD, LiveServer

FRAME_S = 1 / 90
SPEED = 4.0
HAND, FOOT = 2, 3
"""The ids of the first two task phases."""
RESTART_S = 0.5
LOST_FRAMES = 2 * MESSAGES_AHEAD * FRAMES_PER_BATCH
Wear = Callable[[Cast, Relay], Coroutine[Any, Any, None]]


@dataclass(frozen=True)
class Outcome:
    """The session's view and events after a rehearsal with faults."""

    session_id: str
    view: dict[str, Any]
    events: list[dict[str, Any]]

    def pauses(self, phase_id: int) -> list[dict[str, Any]]:
        """Return the pauses of a phase, with their causes."""
        return [
            event["data"]
            for event in self.events
            if event["type"] == "phase_paused" and event["data"]["phase_id"] == phase_id
        ]


def rehearse_with(server: LiveServer, wear: Wear, ledger: LedgerJournal) -> Outcome:
    """Run a short session through a relay while `wear` injects a fault, and check the result."""
    study = add_short_study(server)
    outcome = asyncio.run(_perform(server, study, wear, ledger))
    active_s = [phase["active_s"] for phase in outcome.view["phases"]]
    assert outcome.view["status"] == "completed"
    assert active_s == pytest.approx([ROAM_S] + [PHASE_S] * TASKS, abs=FRAME_S)
    assert {(step["status"], step["attempt"]) for step in outcome.view["steps"]} == {("done", 1)}
    return outcome


async def _perform(server: LiveServer, study: str, wear: Wear, ledger: LedgerJournal) -> Outcome:
    async with relayed(server.port) as relay:
        plan = RehearsalPlan(relay.url, study, speed=SPEED, seed=3, password=ADMIN_PASSWORD)
        async with assembled(plan, journal=ledger) as cast:
            async with asyncio.TaskGroup() as group:
                group.create_task(operate(cast))
                group.create_task(answer(cast))
                group.create_task(wear(cast, relay))
            session_id = cast.operator.session_id
            path = f"/api/sessions/{session_id}/events"
            events = await call(cast.operator.client, "GET", path)
            return Outcome(session_id, await cast.operator.view(), events)


def worn_while(fault: Callable[[Cast, Relay], Coroutine[Any, Any, None]]) -> Wear:
    """Return a function that wears the headset to the end of the session while `fault` happens."""

    async def wear(cast: Cast, relay: Relay) -> None:
        async with asyncio.TaskGroup() as group:
            group.create_task(cast.headset.run())
            group.create_task(fault(cast, relay))

    return wear


def sound(server: LiveServer, outcome: Outcome, ledger: LedgerJournal) -> bool:
    """Return whether everything acknowledged is stored exactly once and unaltered."""
    with record_of(server) as db:
        return reconcile(db, outcome.session_id, ledger).sound


def test_a_cut_connection_pauses_the_phase_and_keeps_the_epoch(
    live_server: LiveServer,
) -> None:
    """A cut connection pauses a hand or foot phase; the same epoch continues to its full time."""
    ledger = LedgerJournal()

    async def cut(cast: Cast, relay: Relay) -> None:
        for phase_id in (HAND, FOOT):
            await Watch(cast).running(phase_id)
            await asyncio.sleep(0.2)
            relay.cut()

    outcome = rehearse_with(live_server, worn_while(cut), ledger)
    assert {epoch for _, epoch in ledger.sent} == {1}
    assert outcome.pauses(HAND)
    assert sound(live_server, outcome, ledger)


def test_an_outage_of_the_network_costs_no_active_time(live_server: LiveServer) -> None:
    """Neither the server nor the headset counts active time during a network outage."""
    ledger = LedgerJournal()

    async def go_dark(cast: Cast, relay: Relay) -> None:
        for phase_id in (HAND, FOOT):
            await Watch(cast).running(phase_id)
            await asyncio.sleep(0.2)
            async with relay.outage():
                await asyncio.sleep(1.0)

    outcome = rehearse_with(live_server, worn_while(go_dark), ledger)
    assert {pause["cause"] for pause in outcome.pauses(HAND)} <= {"headset_lost", "disconnected"}
    assert sound(live_server, outcome, ledger)


def test_a_restarted_headset_continues_with_the_remaining_time(
    live_server: LiveServer,
) -> None:
    """A restarted headset gets a new epoch and continues the phase for its remaining time.

    Only what the old run had not sent is lost.
    """
    ledger, second = LedgerJournal(), LedgerJournal()

    async def start_again(cast: Cast, _: Relay) -> None:
        first = asyncio.create_task(cast.headset.run())
        await Watch(cast).running(HAND)
        await asyncio.sleep(0.3)
        first.cancel()
        old = cast.headset.client
        await old.__aexit__(None, None, None)
        await asyncio.sleep(RESTART_S)
        clock = FrameClock(SPEED)
        async with TelemetryClient(
            old.url, old.token, old.name, clock.now_s, journal=second
        ) as client:
            person = make_person(np.random.default_rng(3), None)
            cast.headset = Headset(client, person, tasks_of(client), clock)
            await cast.headset.run()

    outcome = rehearse_with(live_server, start_again, ledger)
    assert {epoch for _, epoch in second.sent} == {2}
    merged = both_runs(ledger, second)
    with record_of(live_server) as db:
        found = reconcile(db, outcome.session_id, merged)
        refused = db.scalar(select(func.count()).where(~ClientReport.accepted))
        runs = phase_frames(db, outcome.session_id, StreamName.ACTUAL, HAND)
    assert found.sound
    assert refused == 0
    assert outcome.pauses(HAND)
    # Both runs together had the phase's time, except for what the first could no longer send.
    active = [int(frames.active.sum()) for _, frames in runs]
    assert len(active) == 2
    assert PHASE_S * 90 - LOST_FRAMES <= sum(active) <= PHASE_S * 90 + 2


def both_runs(first: LedgerJournal, second: LedgerJournal) -> LedgerJournal:
    """Combine the journals of both runs of a headset."""
    return replace(first, sent={**first.sent, **second.sent}, acked={**first.acked, **second.acked})


def test_a_form_resent_after_a_crash_is_stored_once(tmp_path: Path) -> None:
    """A form that is resent after a lost response or a server crash is stored exactly once.

    Every attempt returns the same receipt.
    """
    with LiveServer(tmp_path / "live") as server:
        asyncio.run(_send_forms(server))


async def _send_forms(server: LiveServer) -> None:
    plan = RehearsalPlan(
        server.url, "reembodiment-latency", speed=1.0, seed=3, password=ADMIN_PASSWORD
    )
    async with assembled(plan) as cast:
        view = await cast.operator.view()
        await cast.operator.command(view, "start")
        await cast.tablet.acknowledge(0)
        form = (await cast.tablet.state())["administration"]
        answers = _answers(form["instrument"])
        await asyncio.to_thread(server.kill)
        sending = [
            asyncio.create_task(cast.tablet.submit(form, answers, "the-same-key")) for _ in range(3)
        ]
        await asyncio.sleep(0.3)
        await asyncio.to_thread(server.start)
        receipts = [await one for one in sending]
        await asyncio.to_thread(server.kill)
        again = asyncio.create_task(cast.tablet.submit(form, answers, "the-same-key"))
        await asyncio.to_thread(server.start)
        receipts.append(await again)
        path = f"/api/sessions/{cast.operator.session_id}/answers"
        stored = await call(cast.operator.client, "GET", path)
    assert len({receipt["receipt_id"] for receipt in receipts}) == 1
    assert [receipt["duplicate"] for receipt in receipts].count(False) == 1
    assert len(stored) == 1


def _answers(instrument: dict[str, Any]) -> dict[str, Any]:
    rng = np.random.default_rng(1)
    return fill_in(instrument, make_person(rng, None), None, None, rng)
