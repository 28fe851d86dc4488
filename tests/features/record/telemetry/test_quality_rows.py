"""Tests of the quality of a phase's streams, computed from its stored frames."""

import numpy as np
import pytest
from numpy.typing import NDArray
from sqlalchemy.orm import Session

from app.features.record.telemetry.quality_rows import phase_quality
from app.models import PhaseQuality, StudySession
from app.science.skeleton import JOINT_INDEX
from app.wire import BODY_STREAMS, StreamName
from tests.features.builders import SessionSpec, build_session
from tests.features.lab import Lab
from tests.features.movement_builders import RATE_HZ, store_batch, store_chunks
from tests.features.session_filler import stable_id
from tests.science.stream_quality.recordings import Recording, generated

HEAD = JOINT_INDEX["Head"]
PHASE, BEFORE = 2, 1
Values = NDArray[np.float32]


@pytest.fixture
def session_id(lab: Lab, request: pytest.FixtureRequest) -> str:
    """Return a session without frames."""
    with lab.database.writing() as db:
        return build_session(db, SessionSpec(stable_id(request.node.name)[:12])).id


def values_of(recording: Recording) -> Values:
    """Return the frames of a recording in the layout of the wire."""
    flat = recording.rotations.reshape(len(recording), -1)
    return np.concatenate((recording.positions_m, flat), axis=1)


def store(
    db: Session,
    session_id: str,
    values: dict[StreamName, Values],
    seqs: NDArray[np.int64] | None = None,
    *,
    epoch: int = 1,
    phase_id: int = PHASE,
) -> None:
    """Store frames of both streams; the frame of a seq has the time seq / 90 s."""
    for stream, of in values.items():
        picked = np.arange(len(of)) if seqs is None else seqs
        store_chunks(db, session_id, stream, picked.tolist(), of, epoch=epoch, phase_id=phase_id)


def both(values: Values) -> dict[StreamName, Values]:
    """Return the same values for both streams."""
    return dict.fromkeys(BODY_STREAMS, values)


def quality(lab: Lab, session_id: str) -> dict[str, PhaseQuality]:
    """Return the quality rows of the phase by stream."""
    with lab.database.reading() as db:
        return {row.stream: row for row in phase_quality(db, session_id, PHASE)}


@pytest.mark.one_engine
def test_valid_frames_have_no_fault(lab: Lab, session_id: str) -> None:
    """Valid frames have no faults; each stream has a row with their number."""
    with lab.database.writing() as db:
        store(db, session_id, both(values_of(generated())))
    for row in quality(lab, session_id).values():
        assert (row.session_id, row.phase_id, row.frames) == (session_id, PHASE, 28 * RATE_HZ)
        assert row.frame_rate_hz == pytest.approx(RATE_HZ)
        assert row.span_s == pytest.approx(28.0 - 1 / RATE_HZ)
        faults = (row.gaps, row.jumps, row.non_unit, row.non_finite, row.backwards)
        assert (faults, row.gap_s, row.longest_gap_s) == ((0, 0, 0, 0, 0), 0.0, 0.0)
        assert (row.frozen_s, row.frozen_joints) == (0.0, [])


@pytest.mark.one_engine
def test_each_stream_has_its_own_faults(lab: Lab, session_id: str) -> None:
    """Faults are counted in the stream in which they occur."""
    frozen, broken = generated().copy(), generated().copy()
    frozen.rotations[900:1350, HEAD] = frozen.rotations[900, HEAD]
    broken.rotations[100, HEAD] = np.nan
    broken.rotations[200, HEAD] *= 1.1
    streams = {StreamName.TARGET: values_of(frozen), StreamName.ACTUAL: values_of(broken)}
    with lab.database.writing() as db:
        store(db, session_id, streams)
    rows = quality(lab, session_id)
    assert rows["target"].frozen_joints == ["Head"]
    assert rows["target"].frozen_s == pytest.approx(5.0, abs=0.05)
    assert (rows["target"].non_finite, rows["target"].non_unit) == (0, 0)
    assert (rows["actual"].non_finite, rows["actual"].non_unit) == (1, 1)
    assert rows["actual"].frozen_joints == []


@pytest.mark.one_engine
def test_a_gap_in_the_frames_is_counted(lab: Lab, session_id: str) -> None:
    """Two seconds without frames are counted as one gap."""
    values = values_of(generated())
    kept = np.r_[0:900, 1080:1800]
    with lab.database.writing() as db:
        store(db, session_id, both(values[kept]), kept)
    for row in quality(lab, session_id).values():
        assert row.gaps == 1
        assert row.longest_gap_s == pytest.approx(181 / RATE_HZ)
        assert row.gap_s == row.longest_gap_s


@pytest.mark.one_engine
def test_frames_before_the_phase_are_context_only(lab: Lab, session_id: str) -> None:
    """Frames before the phase show that a joint was frozen already; their faults do not count."""
    before, own = generated().part(slice(0, 900)).copy(), generated().part(slice(900, 1800)).copy()
    before.rotations[100, HEAD] = np.nan
    own.rotations[:360, HEAD] = before.rotations[-91:, HEAD] = own.rotations[0, HEAD]
    with lab.database.writing() as db:
        seqs = np.arange(900)
        store(db, session_id, both(values_of(before)), seqs, phase_id=BEFORE)
        store(db, session_id, both(values_of(own)), seqs + 900)
    row = quality(lab, session_id)["target"]
    assert (row.frames, row.non_finite) == (900, 0)
    assert row.frozen_joints == ["Head"]
    assert row.frozen_s == pytest.approx(4.0, abs=1.1)


def test_frames_that_are_not_folded_yet_count_too(lab: Lab, session_id: str) -> None:
    """Frames that are not folded into chunks yet are counted."""
    values = values_of(generated())
    with lab.database.writing() as db:
        store(db, session_id, both(values[:900]))
        for stream in BODY_STREAMS:
            store_batch(db, session_id, stream, 900, values[900:990], phase_id=PHASE)
    assert {row.frames for row in quality(lab, session_id).values()} == {990}


@pytest.mark.one_engine
def test_runs_of_the_client_add_up(lab: Lab, session_id: str) -> None:
    """The frames of two runs of the client add up; the time between them is no gap."""
    values = values_of(generated())
    with lab.database.writing() as db:
        store(db, session_id, both(values[:900]), epoch=1)
        store(db, session_id, both(values[900:1350]), epoch=2)
    for row in quality(lab, session_id).values():
        assert (row.frames, row.gaps, row.jumps) == (1350, 0, 0)


@pytest.mark.one_engine
def test_a_phase_without_frames_has_rows_too(lab: Lab, session_id: str) -> None:
    """A phase without frames has quality rows with a count of zero."""
    rows = quality(lab, session_id)
    assert set(rows) == {"target", "actual"}
    assert {(row.frames, row.frame_rate_hz) for row in rows.values()} == {(0, None)}


def test_the_rows_can_be_stored(lab: Lab, session_id: str) -> None:
    """The quality rows can be stored in the database."""
    with lab.database.writing() as db:
        store(db, session_id, both(values_of(generated())))
        db.add_all(phase_quality(db, session_id, PHASE))
    with lab.database.reading() as db:
        row = db.get_one(PhaseQuality, (session_id, PHASE, "actual"))
        assert db.get_one(StudySession, row.session_id).id == session_id
