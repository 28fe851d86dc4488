"""Tests of a phase's achieved latency, from stored frames to its row and the cockpit."""

import time
from dataclasses import replace

import numpy as np
import pytest
from sqlalchemy import select

from app.features.record.telemetry.latencies import phase_latency
from app.features.record.telemetry.summaries import Summariser
from app.models import JointErrorRow, Phase, PhaseLatency, StudySession
from app.science.rotations import FloatArray
from tests.api.people import sign_in
from tests.features.builders import SessionSpec, build_session
from tests.features.lab import STUDY, Json, Lab, ok
from tests.features.latency_builders import measured, store_movement
from tests.features.session_filler import stable_id
from tests.science.moving_bodies import made_movement

MS = 0.001
NUMBERS = ("achieved_latency_ms", "achieved_low_ms", "achieved_high_ms")


@pytest.fixture
def session_id(lab: Lab, request: pytest.FixtureRequest) -> str:
    """Return a session whose phases have ended without summaries."""
    with lab.database.writing() as db:
        return build_session(db, SessionSpec(stable_id(request.node.name)[:12])).id


def phases(lab: Lab, session_id: str) -> dict[float, Phase]:
    """Return one task phase for each set latency."""
    with lab.database.reading() as db:
        found = db.scalars(
            select(Phase).where(Phase.session_id == session_id, Phase.kind == "task")
        )
        return {phase.latency_ms: phase for phase in found}


def summarise(lab: Lab, *expected: Phase) -> dict[int, PhaseLatency]:
    """Run the summariser until these phases have latency rows; return all rows by phase."""
    summariser = Summariser(lab.context)
    summariser.start()
    target = {phase.phase_id for phase in expected}
    rows: dict[int, PhaseLatency] = {}
    deadline_s = time.monotonic() + 30.0
    while time.monotonic() < deadline_s and not target <= set(rows):
        time.sleep(0.05)
        with lab.database.reading() as db:
            query = select(PhaseLatency).where(PhaseLatency.session_id == expected[0].session_id)
            rows = {row.phase_id: row for row in db.scalars(query)}
    summariser.stop()
    return rows


def view_of(lab: Lab, phase: Phase) -> Json:
    """Return the phase as the cockpit shows it."""
    (own,) = (
        one for one in lab.view(phase.session_id)["phases"] if one["phase_id"] == phase.phase_id
    )
    return dict(own)


@pytest.mark.one_engine
@pytest.mark.parametrize("latency_ms", [0.0, 125.0, 350.0])
def test_the_latency_is_measured_from_stored_frames(
    lab: Lab, session_id: str, latency_ms: float
) -> None:
    """The achieved latency is measured from the stored frames within 0.1 ms."""
    phase = phases(lab, session_id)[latency_ms]
    with lab.database.writing() as db:
        store_movement(db, phase, latency_ms / 1000.0)
    with lab.database.reading() as db:
        achieved = phase_latency(db, session_id, phase.phase_id)
    assert achieved.latency_s == pytest.approx(latency_ms / 1000.0, abs=0.1 * MS)
    # Frames before the phase are history and are not counted.
    assert achieved.samples == 720


def test_the_summariser_stores_a_row_for_every_ended_phase(lab: Lab, session_id: str) -> None:
    """The summariser stores one latency row for each ended phase, with a reason if it has none."""
    by_latency = phases(lab, session_id)
    good, late, empty = (by_latency[latency_ms] for latency_ms in (125.0, 350.0, 0.0))
    with lab.database.writing() as db:
        store_movement(db, good, 0.125)
        store_movement(db, late, 0.370, epoch=2, clock_s=500.0)
    rows = summarise(lab, good, late, empty)
    assert rows[good.phase_id].achieved_s == pytest.approx(0.125, abs=0.1 * MS)
    assert (rows[good.phase_id].flagged, rows[good.phase_id].reason) == (False, None)
    assert rows[late.phase_id].achieved_s == pytest.approx(0.370, abs=0.1 * MS)
    assert rows[late.phase_id].flagged
    assert rows[late.phase_id].ordered_s == 0.350
    assert rows[empty.phase_id].achieved_s is None
    assert rows[empty.phase_id].reason == "There are no active frames of both bodies."
    with lab.database.reading() as db:
        errors = select(JointErrorRow.samples).where(
            JointErrorRow.session_id == session_id, JointErrorRow.phase_id == good.phase_id
        )
        assert set(db.scalars(errors)) == {720}
    assert list(summarise(lab, good)) == list(rows)


@pytest.mark.one_engine
def test_runs_of_the_client_are_measured_together(lab: Lab, session_id: str) -> None:
    """The movement of a phase before and after a headset's restart is measured together."""
    phase = phases(lab, session_id)[125.0]
    with lab.database.writing() as db:
        for epoch, clock_s in ((1, 3000.0), (2, 0.5)):
            store_movement(db, phase, 0.125, duration_s=4.0, epoch=epoch, clock_s=clock_s)
    row = summarise(lab, phase)[phase.phase_id]
    assert row.achieved_s == pytest.approx(0.125, abs=0.2 * MS)
    assert row.movement_s == pytest.approx(8.0, abs=0.2)
    assert row.samples == 720


@pytest.mark.one_engine
def test_too_little_movement_gives_a_reason_instead_of_a_latency(lab: Lab, session_id: str) -> None:
    """A phase with too little movement has a reason instead of a latency."""
    phase = phases(lab, session_id)[125.0]
    movement = made_movement(np.random.default_rng(0))

    def stops(times_s: FloatArray) -> FloatArray:
        return movement(np.minimum(times_s, 4.0))

    with lab.database.writing() as db:
        store_movement(db, phase, 0.125, movement=stops)
    row = summarise(lab, phase)[phase.phase_id]
    assert (row.achieved_s, row.low_s, row.high_s, row.flagged) == (None, None, None, False)
    assert row.movement_s == pytest.approx(2.0, abs=0.1)
    assert row.reason == "2.0 s of movement above 20 deg/s; 5 s are needed."


@pytest.mark.one_engine
def test_the_cockpit_shows_achieved_and_set_latency(lab: Lab, session_id: str) -> None:
    """The cockpit shows achieved and set latency with interval, tolerance and reason."""
    by_latency = phases(lab, session_id)
    fine, off, still = (by_latency[latency_ms] for latency_ms in (125.0, 350.0, 0.0))
    assert view_of(lab, fine)["movement_s"] is None
    with lab.database.writing() as db:
        db.add_all([measured(fine, 0.1251), measured(off, 0.370, flagged=True)])
        db.add(measured(still, None))
    shown = view_of(lab, fine)
    assert [shown[name] for name in NUMBERS] == [125.1, 124.7, 125.5]
    assert (shown["latency_ms"], shown["latency_off"]) == (125.0, False)
    assert view_of(lab, off)["latency_off"] is True
    shown = view_of(lab, still)
    assert [shown[name] for name in (*NUMBERS, "latency_off")] == [None] * 4
    assert (shown["latency_reason"], shown["movement_s"]) == ("3.2 s of movement.", 3.25)


@pytest.mark.one_engine
def test_a_blinded_operator_sees_only_whether_the_latency_is_off(fresh_lab: Lab) -> None:
    """A blinded operator sees only whether the latency is within tolerance."""
    yaml = ok(fresh_lab.operator.get(f"/api/studies/{STUDY}"))["yaml"]
    blinded = yaml.replace("operator: false", "operator: true")
    ok(fresh_lab.operator.post(f"/api/studies/{STUDY}/versions", json={"yaml": blinded}))
    with fresh_lab.database.writing() as db:
        session_id = build_session(db, SessionSpec("P-0001")).id
    by_latency = phases(fresh_lab, session_id)
    off, still = by_latency[350.0], by_latency[0.0]
    with fresh_lab.database.writing() as db:
        row = measured(off, 0.370, flagged=True)
        row.reason = "The movement repeats itself: 1370 ms would fit as well."
        db.add_all([row, measured(still, None)])
    fresh_lab = replace(fresh_lab, operator=sign_in(fresh_lab, "operator"))
    shown = view_of(fresh_lab, off)
    assert shown["latency_off"] is True
    assert [shown[name] for name in (*NUMBERS, "latency_ms", "latency_reason")] == [None] * 5
    assert view_of(fresh_lab, still)["latency_off"] is None


@pytest.mark.one_engine
def test_a_new_latency_is_published(
    lab: Lab, session_id: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The session is published as changed when a latency has been measured."""
    heard: list[tuple[str, str]] = []
    monkeypatch.setattr(lab.context.hub, "publish", lambda *news: heard.append(news))
    summarise(lab, *phases(lab, session_id).values())
    assert (session_id, "session") in heard


def test_a_void_phase_is_not_measured(lab: Lab) -> None:
    """The latency of a void phase is not measured."""
    with lab.database.writing() as db:
        spec = SessionSpec("P-voided", redone=("block1.hand",))
        session = build_session(db, spec)
    assert isinstance(session, StudySession)
    with lab.database.reading() as db:
        found = list(db.scalars(select(Phase).where(Phase.session_id == session.id)))
    done = [phase for phase in found if phase.status == "done"]
    rows = summarise(lab, *done)
    assert set(rows) == {phase.phase_id for phase in done}
    assert len(done) < len(found)
