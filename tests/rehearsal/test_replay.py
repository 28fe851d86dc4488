"""Tests that a replay shows every event of a rehearsal at the headset's own time."""

from datetime import timedelta

import pytest
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.results.replay.service import Replayable
from app.features.results.replay.timeline import replay_of
from app.features.results.replay.times import phase_clock
from app.models import Completion, Contact, Phase
from app.platform.access import session_by_id
from tests.rehearsal.performed import PHASES, Performed

US = 1e-6


@pytest.fixture
def phases(performed: Performed, db: Session) -> list[Phase]:
    """Provide the phases of the rehearsal."""
    query = select(Phase).where(Phase.session_id == performed.session_id)
    return list(db.scalars(query.order_by(Phase.phase_id)))


@pytest.mark.one_engine
def test_contacts_and_completions_are_at_the_headsets_time(
    db: Session, phases: list[Phase]
) -> None:
    """Contacts and completions are at the headset's time, to the microsecond.

    They are located by their active time, across every walk back.
    """
    session = session_by_id(db, phases[0].session_id)
    walks = 0
    for phase in phases:
        clock = phase_clock(db, session, phase)
        walks += len(clock.active) - 1
        of_phase = (Contact.session_id == session.id, Contact.phase_id == phase.phase_id)
        seen = [
            pair
            for row in db.scalars(select(Contact).where(*of_phase))
            for pair in (
                (row.epoch, row.begin_s, row.begin_active_s),
                (row.epoch, row.end_s, row.end_active_s),
            )
        ]
        done = (Completion.session_id == session.id, Completion.phase_id == phase.phase_id)
        seen += [
            (row.epoch, row.at_s, row.active_s)
            for row in db.scalars(select(Completion).where(*done))
        ]
        for epoch, client_s, active_s in seen:
            assert clock.of_counted(active_s, epoch, client_s) == pytest.approx(
                client_s + clock.offsets_s[epoch], abs=US
            )
    assert walks > 0


def test_the_active_intervals_add_up_to_the_active_time(db: Session, phases: list[Phase]) -> None:
    """The active intervals of a replayed phase are in order and add up to its active time."""
    session = session_by_id(db, phases[0].session_id)
    assert len(phases) == PHASES
    for phase in phases:
        shown = replay_of(db, Replayable(session, phase, "full"))
        assert sum(one.end_s - one.begin_s for one in shown.active) == pytest.approx(
            phase.active_s, abs=1e-3
        )
        edges = [edge for one in shown.active for edge in (one.begin_s, one.end_s)]
        assert edges == sorted(edges)
        assert edges[-1] <= shown.duration_s
        assert shown.moments[0].what == "started"
        assert shown.moments[-1].what == "ended"
        assert shown.moments[0].t_s == 0.0
        (run,) = shown.runs
        assert run.begin_utc is not None
        assert run.uncertainty_ms is not None
        assert phase.started_at is not None
        # The server received it afterwards.
        known = timedelta(milliseconds=run.uncertainty_ms)
        assert run.begin_utc - known <= phase.started_at
