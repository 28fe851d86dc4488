"""Tests of the record of a rehearsed session, on SQLite with a capture and on PostgreSQL."""

from itertools import pairwise
from typing import Any, TypeVar

import numpy as np
import pytest
from sqlalchemy import Select, select
from sqlalchemy.orm import Session

from app.features.design.studies import protocol_of
from app.features.record.headset import participant_info
from app.features.record.receipts.completions import interval_of
from app.features.record.sessions import events_of, verify_chain
from app.models import (
    Completion,
    Contact,
    JointErrorRow,
    Participant,
    Phase,
    StudySession,
    StudyVersion,
)
from app.platform.access import session_by_id
from app.science.tasks import (
    Command,
    CommandKind,
    Laterality,
    TaskLayout,
    TaskRules,
    rederive,
)
from tests.rehearsal.ledger import reconcile
from tests.rehearsal.performed import TASK_PHASES, Performed

FRAME_S = 1 / 90


def test_every_task_phase_lasts_its_whole_active_time(performed: Performed) -> None:
    """Each of three hand and three foot phases is done and lasts its active time to one frame."""
    phases = [phase for phase in performed.view["phases"] if phase["kind"] == "task"]
    assert [phase["limb"] for phase in phases] == ["hand", "foot"] * 3
    assert {phase["status"] for phase in phases} == {"done"}
    assert [phase["active_s"] for phase in phases] == pytest.approx(
        [performed.lengths.task_s] * TASK_PHASES, abs=FRAME_S
    )


def test_the_session_is_complete_and_every_questionnaire_is_scored(performed: Performed) -> None:
    """Every step of the session is done, and each task phase has a scored questionnaire."""
    view = performed.view
    assert view["status"] == "completed"
    assert {step["status"] for step in view["steps"]} == {"done"}
    scored = [row["instrument"] for row in view["scores"]]
    assert scored == ["karas2020"] * TASK_PHASES
    assert all(None not in row["scores"].values() for row in view["scores"])


def test_everything_is_marked_simulated(performed: Performed, db: Session) -> None:
    """Session, participant and report of a rehearsal are marked as simulated."""
    session = session_by_id(db, performed.session_id)
    assert (session.kind, db.get_one(Participant, session.participant_id).kind) == (
        "simulated",
        "simulated",
    )
    assert performed.view["simulated"] is True
    assert performed.report["simulated"] is True
    assert session.time_scale == performed.report["speed"]


def test_what_was_sent_is_stored_bit_for_bit(performed: Performed, db: Session) -> None:
    """All data that the headset sent are stored bit by bit, without loss or duplicates."""
    found = reconcile(db, performed.session_id, performed.ledger)
    assert found.sound
    lengths = performed.lengths
    # Two streams of 90 frames a second, and the frames between the phases.
    least = 2 * 90 * (lengths.roam_s + TASK_PHASES * lengths.task_s)
    assert found.sent == found.acked == found.stored > least


def test_the_report_counts_what_the_server_stored(performed: Performed) -> None:
    """The report's frame counts match the stored ones, and both streams have the same length."""
    report = performed.report
    assert report["frames_sent"] == report["frames_stored"]
    assert report["frames_sent"]["target"] == report["frames_sent"]["actual"]
    assert {row["frames_flagged"] for row in report["streams"]} == {0}


@pytest.mark.one_engine
def test_every_task_phase_has_completions_and_the_session_side_contacts(
    performed: Performed,
) -> None:
    """Every task phase has completions, and the session has side contacts."""
    phases = [phase for phase in performed.view["phases"] if phase["kind"] == "task"]
    assert all(phase["completions"] > 0 for phase in phases)
    assert sum(phase["completions"] for phase in phases) == performed.report["completions"]
    assert performed.report["side_contacts"] > 0


def test_the_event_log_verifies(performed: Performed, db: Session) -> None:
    """Every hash of the event log follows from the previous one."""
    checked = verify_chain(events_of(db, performed.session_id))
    assert checked.ok
    assert checked.events == len(performed.events)


def test_joint_error_grows_with_latency_except_against_the_command(
    performed: Performed, db: Session
) -> None:
    """Joint error is zero at 0 ms and grows with latency; against the command it is zero."""
    for limb in ("hand", "foot"):
        present = [_mean_error_deg(db, performed, limb, ms, "present") for ms in (0, 125, 350)]
        command = [_mean_error_deg(db, performed, limb, ms, "command") for ms in (0, 125, 350)]
        assert present[0] < 1e-9
        assert all(after > before + 0.5 for before, after in pairwise(present))
        # The remainder is the rounding of quaternions to 32 bits.
        assert max(command) < 1e-4


@pytest.mark.one_engine
def test_walks_back_stop_the_clock(performed: Performed, db: Session) -> None:
    """A phase's duration is the sum of its active time, its walks back and its pauses."""
    for phase in _task_phases(db, performed):
        events = _clock_events(performed, phase.phase_id)
        begun, ended = events[0]["data"]["client_t_s"], events[-1]["data"]["client_t_s"]
        stood = [
            after["data"]["client_t_s"] - before["data"]["client_t_s"]
            for before, after in pairwise(events)
            if before["type"] in ("walk_back_started", "phase_paused")
        ]
        assert ended - begun == pytest.approx(phase.active_s + sum(stood), abs=FRAME_S)
        if phase.limb == "foot":
            # The last completion may come so late that the walk back has not ended.
            assert len(stood) >= phase.walk_back_count > 0
            assert ended - begun > phase.active_s + FRAME_S


def test_the_stored_contacts_reproduce_the_stored_completions(
    performed: Performed, db: Session
) -> None:
    """Applying the task rules to the stored contacts reproduces every stored completion."""
    session = session_by_id(db, performed.session_id)
    for phase in _task_phases(db, performed):
        rules = TaskRules(_layout(db, session, phase.limb), _hand(db, session))
        contacts = db.scalars(_of(Contact, phase).order_by(Contact.end_s, Contact.id))
        intervals = [interval_of(row) for row in contacts]
        derived = rederive(rules, intervals, _commands(performed, phase.phase_id))
        stored = db.scalars(_of(Completion, phase).order_by(Completion.number)).all()
        assert [(one.number, one.completed_s) for one in derived] == [
            (row.number, row.at_s) for row in stored
        ]
        assert [one.duration_s for one in derived] == [row.duration_s for row in stored]
        assert [one.out_of_order for one in derived] == [row.out_of_order_touches for row in stored]


def _task_phases(db: Session, performed: Performed) -> list[Phase]:
    query = select(Phase).where(Phase.session_id == performed.session_id, Phase.kind == "task")
    return list(db.scalars(query.order_by(Phase.phase_id)))


Row = TypeVar("Row", Contact, Completion)


def _of(table: type[Row], phase: Phase) -> Select[Row]:
    return select(table).where(
        table.session_id == phase.session_id, table.phase_id == phase.phase_id
    )


def _clock_events(performed: Performed, phase_id: int) -> list[dict[str, Any]]:
    """Return the events of a phase's clock as the headset reported them, from start to freeze."""
    return [
        event
        for event in performed.events
        if event["data"].get("phase_id") == phase_id
        and event["data"].get("client_t_s") is not None
        and event["type"] != "phase_ended"
    ]


def _commands(performed: Performed, phase_id: int) -> list[Command]:
    kinds = {
        "phase_started": CommandKind.START,
        "phase_paused": CommandKind.PAUSE,
        "phase_resumed": CommandKind.RESUME,
        "phase_frozen": CommandKind.FREEZE,
    }
    return [
        Command(kinds[event["type"]], event["data"]["client_t_s"])
        for event in _clock_events(performed, phase_id)
        if event["type"] in kinds
    ]


def _layout(db: Session, session: StudySession, limb: str | None) -> TaskLayout:
    tasks = protocol_of(db.get_one(StudyVersion, session.study_version_id)).tasks
    assert limb is not None
    return tasks.layout(limb)


def _hand(db: Session, session: StudySession) -> Laterality:
    return Laterality(participant_info(db, session).handedness or "")


def _mean_error_deg(
    db: Session, performed: Performed, limb: str, latency_ms: int, reference: str
) -> float:
    """Return the mean over joints of the mean angle, in the phase of this limb and latency."""
    phase = next(
        phase
        for phase in _task_phases(db, performed)
        if (phase.limb, phase.latency_ms) == (limb, latency_ms)
    )
    means = db.scalars(
        select(JointErrorRow.mean_rad).where(
            JointErrorRow.session_id == performed.session_id,
            JointErrorRow.phase_id == phase.phase_id,
            JointErrorRow.reference == reference,
            JointErrorRow.axis == "angle",
        )
    ).all()
    assert len(means) == 21
    return float(np.degrees(np.mean([mean for mean in means if mean is not None])))
