"""Tests that the server's wall clock may be set in mid-phase, as a time service does."""

import json
from collections.abc import Iterator
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from itertools import pairwise
from typing import Any

import numpy as np
import pytest
from starlette.testclient import WebSocketTestSession

from app.clock import Clock
from app.features.results.analysis.tables import completions_table, contacts_table, phases_table
from app.models import SessionEvent
from tests.faults.figures import note
from tests.features.lab import STUDY, Json, Lab, running_lab
from tests.wire.samples import message, standing

STEPS_S = (-3600.0, 7200.0, -30.0, 0.5, -0.5)
PHASE_S = 120.0


@dataclass
class Headset:
    """A headset connected to the application's own socket."""

    socket: WebSocketTestSession
    epoch: int = 0
    next_report: int = 0
    next_frame: int = 0

    def hear(self, kind: str) -> Json:
        """Return the next message of this kind from the server."""
        while True:
            heard: Json = json.loads(self.socket.receive_text())
            if heard["type"] == kind:
                return heard

    def report(self, **body: Any) -> None:
        """Send a report and wait until it is stored."""
        seq, self.next_report = self.next_report, self.next_report + 1
        text = json.dumps({"type": "report", "epoch": self.epoch, "seq": seq, "body": body})
        self.socket.send_text(text)
        while not any(
            one["stream"] == "reports" and one["next_seq"] > seq
            for one in self.hear("ack")["positions"]
        ):
            pass

    def move(self, t_s: float, active_s: float, phase_id: int) -> None:
        """Send nine frames with timestamps up to `t_s`."""
        times_s = t_s - np.arange(8, -1, -1) / 90.0
        first, self.next_frame = self.next_frame, self.next_frame + 9
        self.socket.send_bytes(
            message(
                standing(9),
                epoch=self.epoch,
                seq_first=first,
                phase_id=phase_id,
                times_s=times_s,
                active=True,
                active_s=active_s,
            )
        )


@dataclass
class WallClock:
    """A wall clock that can be set; the monotonic clock cannot."""

    offset: timedelta = field(default_factory=timedelta)

    def utc_now(self) -> datetime:
        """Return the time that the wall clock shows."""
        return datetime.now(UTC) + self.offset


@pytest.fixture
def wall() -> WallClock:
    """Provide the wall clock."""
    return WallClock()


@pytest.fixture
def stepped(database_url: str, wall: WallClock) -> Iterator[Lab]:
    """Provide a running application that uses the wall clock of the test."""
    with running_lab(database_url, Clock(utc_now=wall.utc_now)) as lab:
        yield lab


def test_durations_do_not_depend_on_the_wall_clock(stepped: Lab, wall: WallClock) -> None:
    """Setting the wall clock in mid-phase changes no active time and makes no interval negative."""
    view = stepped.skip_to(stepped.join(), "free_roam")
    offered = ["reembody.v1", f"bearer.{stepped.headset_token(view['id'])}"]
    with stepped.operator.websocket_connect("/api/vr/stream", subprotocols=offered) as socket:
        headset = Headset(socket)
        socket.send_text(json.dumps({"type": "hello", "protocol": 1, "client": "test"}))
        headset.epoch = headset.hear("welcome")["epoch"]
        _run_phase(stepped, view["id"], headset, wall)
        after = stepped.view(view["id"])
    (phase,) = after["phases"]
    assert (phase["status"], phase["active_s"]) == ("done", PHASE_S)
    negative = _negative_intervals(stepped, view["id"])
    note(16, "wall clock set in mid-phase", "steps (s)", ", ".join(f"{s:+g}" for s in STEPS_S))
    note(16, "wall clock set in mid-phase", "negative intervals", negative)
    assert negative == 0


def _run_phase(lab: Lab, session_id: str, headset: Headset, wall: WallClock) -> None:
    """Run the free movement, with the wall clock set before every part of it."""
    lab.command(lab.view(session_id), "begin_phase")
    state = headset.hear("state")
    while state["phase"] is None:
        state = headset.hear("state")
    phase_id = state["phase"]["phase_id"]
    told: Json = {"kind": "phase", "phase_id": phase_id}
    headset.report(**told, what="started", t_s=10.0, active_s=0.0)
    for part, step_s in enumerate(STEPS_S):
        wall.offset += timedelta(seconds=step_s)
        active_s = 10.0 * (part + 1)
        headset.move(10.0 + active_s, active_s, phase_id)
        headset.report(
            kind="contact",
            phase_id=phase_id,
            surface="hand/2/left",
            surface_kind="side",
            box=2,
            side="left",
            body_part="RightHand",
            begin_s=9.0 + active_s,
            end_s=10.0 + active_s,
            begin_active_s=active_s - 1.0,
            end_active_s=active_s,
            effect="side",
        )
    headset.report(**told, what="time_up", t_s=10.0 + PHASE_S, active_s=PHASE_S)
    headset.report(**told, what="ended", t_s=12.0 + PHASE_S, active_s=PHASE_S)


def _negative_intervals(lab: Lab, session_id: str) -> int:
    """Return how many phases, contacts, completions and gaps between events last below zero."""
    with lab.database.reading() as db:
        phases = phases_table(db, STUDY, "people")
        contacts = contacts_table(db, STUDY, "people")
        completions = completions_table(db, STUDY, "people")
        events = (
            db.query(SessionEvent).filter_by(session_id=session_id).order_by(SessionEvent.seq).all()
        )
    assert len(contacts) == len(STEPS_S)
    return int(
        (phases["active_s"] < 0).sum()
        + (phases["client_ended_s"] < phases["client_started_s"]).sum()
        + (contacts["duration_s"] < 0).sum()
        + (completions["duration_s"] < 0).sum()
        + sum(after.monotonic_ns < before.monotonic_ns for before, after in pairwise(events))
    )
