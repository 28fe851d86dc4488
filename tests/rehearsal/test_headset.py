"""Tests of the scripted headset without a network."""

import asyncio
import time
from typing import cast

import numpy as np
import pytest

from app.client.telemetry import TelemetryClient
from app.protocol import Tasks
from app.rehearsal.frame_clock import FrameClock
from app.rehearsal.headset import Headset
from app.simulated_people.body import make_person
from app.wire.messages import CompletionReport, ContactReport, PhaseOrder
from tests.protocol.helpers import study
from tests.rehearsal.orders import InstantServer, order

AS_FAST_AS_IT_GOES = 1e9


def play(seed: int, phase: PhaseOrder) -> InstantServer:
    """Run a whole phase with the given seed."""
    server = InstantServer(phase)
    person = make_person(np.random.default_rng(seed), None)
    client = cast("TelemetryClient", server)
    asyncio.run(Headset(client, person, shipped_tasks(), FrameClock(AS_FAST_AS_IT_GOES)).run())
    return server


def shipped_tasks() -> Tasks:
    """Return the boxes of the shipped study."""
    return study().tasks


def test_a_clock_that_fell_behind_does_not_catch_up(monkeypatch: pytest.MonkeyPatch) -> None:
    """After a stall, a clock faster than real time passes no more than its speed times the time."""
    now_s = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    clock = FrameClock(4.0)
    clock.start()
    now_s += 10.0
    assert clock.wait_s() == 0.0
    stalled_s, began_s = clock.t_s, now_s
    for _ in range(720):
        clock.frame += 1
        now_s += clock.wait_s()
    assert clock.t_s - stalled_s == 8.0
    assert now_s - began_s == pytest.approx(2.0)


def test_a_headset_in_real_time_keeps_its_own_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    """In real time a late frame is drawn immediately, and the clock does not lose the time."""
    now_s = 100.0
    monkeypatch.setattr(time, "monotonic", lambda: now_s)
    clock = FrameClock(1.0)
    clock.start()
    now_s += 10.0
    clock.frame += 90
    assert (clock.wait_s(), clock.now_s()) == (0.0, 1.0)
    clock.frame += 900
    assert clock.wait_s() == pytest.approx(1.0)


def test_the_same_seed_gives_the_same_movement_and_the_same_touches() -> None:
    """The same seed gives bit-identical frames and reports; another seed gives different ones."""
    phase = order(limb="hand", kind="task", duration_s=8.0, latency_ms=125.0)
    first, again, other = play(3, phase), play(3, phase), play(4, phase)
    assert first.digests == again.digests
    assert first.reports == again.reports
    assert set(first.digests).isdisjoint(other.digests)


def test_a_foot_phase_walks_back_after_each_task() -> None:
    """In a foot phase every completion is followed by a walk back with a stopped clock."""
    phase = order(limb="foot", kind="task", duration_s=20.0)
    played = play(3, phase)
    words = [getattr(report, "what", report.kind) for report in played.reports]
    assert words.count("completion") >= 1
    assert words.count("walk_back_started") == words.count("completion")
    assert abs(words.count("walk_back_ended") - words.count("walk_back_started")) <= 1


def test_contacts_come_before_the_completion_they_lead_to() -> None:
    """Contacts are reported before their completion, with numbers that continue the order's."""
    phase = order(limb="hand", kind="task", duration_s=20.0, completions=4, active_s=0.0)
    reports = play(5, phase).reports
    numbers = [report.number for report in reports if isinstance(report, CompletionReport)]
    assert numbers == list(range(5, 5 + len(numbers)))
    first = next(at for at, one in enumerate(reports) if isinstance(one, CompletionReport))
    effects = [one.effect for one in reports[:first] if isinstance(one, ContactReport)]
    assert effects.count("green") == 4


def test_the_order_is_reversed_after_an_odd_number_of_tasks() -> None:
    """A client that takes over after an odd number of tasks uses the reversed order of boxes."""
    phase = order(limb="hand", kind="task", duration_s=20.0)
    there = _first_order(play(5, phase))
    back = _first_order(play(5, phase.model_copy(update={"completions": 1})))
    assert there == back[::-1]


def _first_order(server: InstantServer) -> tuple[int, ...]:
    return next(one.order for one in server.reports if isinstance(one, CompletionReport))
