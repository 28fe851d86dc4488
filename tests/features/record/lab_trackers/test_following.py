"""Tests of how sessions that use trackers are looked after, one by one, without any socket."""

import pytest
from sqlalchemy import select

from app.adapters.live import Pose
from app.features.design.studies import create_study, study_by_key
from app.features.movement.live import Sample
from app.features.record.demo.demo_study import DEMO_KEY, demo_yaml, remove_study
from app.features.record.lab_trackers import LabTrackers, service
from app.models import TrackerChunk
from tests.features.builders import NOW
from tests.features.lab import STUDY, Lab, ok


@pytest.fixture
def trackers(fresh_lab: Lab) -> LabTrackers:
    """The lab's trackers without their thread, so that a test says when they are looked after."""
    found = fresh_lab.context.part(LabTrackers)
    found.stop()
    return found


def waits(lab: Lab, trackers: LabTrackers, study: str) -> str:
    """Make a session with trackers, of which one sample waits to be stored; return its id."""
    joined = lab.operator.post(f"/api/studies/{study}/sessions", json={"kind": "simulated"})
    session_id = str(ok(joined)["id"])
    path = f"/api/sessions/{session_id}/trackers"
    ok(lab.operator.put(path, json={"door": "json", "source": "lab"}))
    followed = trackers.followed(session_id)
    assert followed is not None
    pose = Pose("hat", "tracker", (0.0, 1.7, 0.0), (1.0, 0.0, 0.0, 0.0))
    arrival_s = lab.context.clock.monotonic_ns() / 1e9
    followed.waiting.add([Sample("json", "lab", "x:1", (pose,), None, arrival_s, arrival_s, None)])
    followed.was_recording = True
    return session_id


def stored(lab: Lab) -> list[str]:
    """Return the sessions of which samples are on disk."""
    with lab.database.reading() as db:
        return list(db.scalars(select(TrackerChunk.session_id)))


@pytest.mark.one_engine
def test_a_deleted_session_keeps_no_other_from_being_stored(
    fresh_lab: Lab, trackers: LabTrackers
) -> None:
    """The demo lab is removed while its headset uses trackers: another session's are stored."""
    with fresh_lab.database.writing() as db:
        create_study(db, demo_yaml(), NOW)
    deleted = waits(fresh_lab, trackers, DEMO_KEY)
    other = waits(fresh_lab, trackers, STUDY)
    with fresh_lab.database.writing() as db:
        remove_study(db, study_by_key(db, DEMO_KEY))
    trackers._look_after_all()
    assert stored(fresh_lab) == [other]
    assert trackers.followed(deleted) is None
    assert not fresh_lab.context.background.failing()


@pytest.mark.one_engine
def test_nothing_is_stored_of_somebody_who_refused_meanwhile(
    fresh_lab: Lab, trackers: LabTrackers, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What waits is discarded if its session is refused when the transaction begins."""
    waits(fresh_lab, trackers, STUDY)
    states = iter(("no", "refused"))
    monkeypatch.setattr(service, "recording_of", lambda *_: next(states))
    trackers._look_after_all()
    assert next(states, None) is None
    assert stored(fresh_lab) == []
    assert not fresh_lab.context.background.failing()


@pytest.mark.one_engine
def test_what_could_not_be_stored_waits_on(
    fresh_lab: Lab, trackers: LabTrackers, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a failure the last samples are stored, also if the trackers were given up since."""
    session_id = waits(fresh_lab, trackers, STUDY)
    path = f"/api/sessions/{session_id}/trackers"

    def full(*_: object, **__: object) -> int:
        raise OSError("no space left on device")

    with monkeypatch.context() as patch:
        patch.setattr(service, "store_samples", full)
        ok(fresh_lab.operator.put(path, json={"door": None, "source": None}))
        trackers._look_after_all()
    assert stored(fresh_lab) == []
    assert [one.name for one in fresh_lab.context.background.failing()] == [service.THREAD]
    trackers._look_after_all()
    assert stored(fresh_lab) == [session_id]
