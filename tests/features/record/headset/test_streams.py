"""Tests of movement over a real socket: what is acknowledged is on disk, exactly as sent."""

import time
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from sqlalchemy import func, select

from app.features.record.doubts import doubts_of
from app.features.record.telemetry.encoding import Frames
from app.features.record.telemetry.frames import concatenate, iter_frames
from app.models import ClockProbe, TelemetryBatch, TelemetryChunk
from app.wire import StreamName
from tests.features.record.headset.site import HELLO, Headset, Site
from tests.wire.samples import bits, every_odd_float, message, standing


def numbered(first: int, count: int) -> NDArray[np.float32]:
    """Return frames whose hip height is their own seq."""
    values = standing(count)
    values[:, 1] = np.arange(first, first + count)
    return values


def stored(site: Site, session_id: str, stream: str = "target", epoch: int = 1) -> Frames:
    """Return every stored frame of a stream as a reader gets it."""
    with site.database.reading() as db:
        return concatenate([frames for _, frames in iter_frames(db, session_id, stream, epoch)])


def frames_on_disk(site: Site, session_id: str) -> int:
    """Return how many frames of a session are stored in batches and chunks."""
    with site.database.reading() as db:
        return sum(
            db.scalar(
                select(func.coalesce(func.sum(table.frame_count), 0)).where(
                    table.session_id == session_id
                )
            )
            or 0
            for table in (TelemetryBatch, TelemetryChunk)
        )


def test_acknowledged_frames_are_on_disk(site: Site) -> None:
    """Frames are in the database as soon as they are acknowledged."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        for first in range(0, 90, 9):
            headset.say(message(numbered(first, 9), seq_first=first))
            headset.acknowledged("target", first + 9)
            assert frames_on_disk(site, session_id) >= first + 9
    assert stored(site, session_id).seq.tolist() == list(range(90))


def test_the_overlap_of_a_batch_is_not_stored_twice(site: Site) -> None:
    """Of a batch that overlaps stored frames only the new part is stored."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(numbered(0, 10)))
        headset.say(message(numbered(5, 10), seq_first=5))
        headset.acknowledged("target", 15)
    frames = stored(site, session_id)
    assert frames.values[:, 1].tolist() == list(range(15))
    assert frames_on_disk(site, session_id) == 15


def test_a_resent_seq_keeps_its_first_content(site: Site) -> None:
    """A resent seq is acknowledged and its first content stays, whatever the new content."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(numbered(0, 10)))
        headset.acknowledged("target", 10)
        for _ in range(3):
            headset.say(message(numbered(500, 10)))
            headset.acknowledged("target", 10)
    assert stored(site, session_id).values[:, 1].tolist() == list(range(10))


@pytest.mark.one_engine
def test_a_skipped_seq_is_requested_again(site: Site) -> None:
    """Frames after a missing seq are not stored until the missing ones have been resent."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(numbered(0, 10)))
        headset.acknowledged("target", 10)
        headset.say(message(numbered(20, 10), seq_first=20))
        resend = headset.hear("resend")
        assert (resend["stream"], resend["next_seq"]) == ("target", 10)
        assert frames_on_disk(site, session_id) == 10
        headset.say(message(numbered(10, 20), seq_first=10))
        headset.acknowledged("target", 30)
    assert stored(site, session_id).values[:, 1].tolist() == list(range(30))


def test_non_finite_numbers_are_stored_exactly_and_flagged(site: Site) -> None:
    """NaN payloads, infinities and denormals are stored bit by bit and reported as flagged."""
    session_id = site.join()
    sent = every_odd_float()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(sent))
        flag = headset.hear("flag")
    assert (flag["code"], flag["seq"], flag["frames"]) == ("non_finite", 0, len(sent))
    assert np.array_equal(bits(stored(site, session_id).values), bits(sent))
    (stream, _) = streams(site, session_id)
    assert (stream["frames_stored"], stream["frames_flagged"]) == (len(sent), len(sent))


@pytest.mark.one_engine
def test_a_non_unit_rotation_is_flagged_at_its_seq(site: Site) -> None:
    """A rotation that is not a unit quaternion is flagged at its seq, and only its frame."""
    session_id = site.join()
    values = standing(10)
    values[7, 3] = 1.5
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(values))
        flag = headset.hear("flag")
    assert (flag["code"], flag["seq"], flag["frames"]) == ("non_unit", 7, 1)


def test_each_stream_has_its_own_position(site: Site) -> None:
    """Target and actual stream are acknowledged independently."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(numbered(0, 20)))
        headset.say(message(numbered(0, 10), stream=StreamName.ACTUAL))
        headset.acknowledged("actual", 10)
    positions = {row["stream"]: row["next_seq"] for row in streams(site, session_id)}
    assert positions == {"target": 20, "actual": 10, "reports": 0}


def test_a_reconnecting_client_receives_its_stored_positions(site: Site) -> None:
    """The welcome of a reconnecting client has the next seq of each stream."""
    session_id = site.join()
    token = site.token(session_id)
    with site.headset(token) as headset:
        headset.say(message(numbered(0, 10)))
        headset.acknowledged("target", 10)
    with site.headset(token, epoch=1) as headset:
        assert headset.epoch == 1
        position = {"stream": "target", "epoch": 1, "next_seq": 10}
        assert position in headset.welcome["positions"]


def test_each_run_of_the_client_has_its_own_epoch(site: Site) -> None:
    """Each run of the client gets its own epoch, so that frames of two runs never mix."""
    session_id = site.join()
    token = site.token(session_id)
    with site.headset(token) as first:
        first.say(message(numbered(0, 5), epoch=1))
        first.acknowledged("target", 5)
        with site.headset(token) as second:
            assert (first.epoch, second.epoch) == (1, 2)
            second.say(message(numbered(100, 5), epoch=2))
            second.acknowledged("target", 5)
    assert stored(site, session_id, epoch=1).values[0, 1] == 0
    assert stored(site, session_id, epoch=2).values[0, 1] == 100


@pytest.mark.one_engine
def test_late_frames_of_an_earlier_run_are_stored(site: Site) -> None:
    """Frames of an earlier run, sent by the next one from its journal, are stored."""
    session_id = site.join()
    token = site.token(session_id)
    with site.headset(token):
        pass
    with site.headset(token) as headset:
        headset.say(message(numbered(0, 5), epoch=1))
        headset.hear("ack", lambda ack: ack["positions"][0]["epoch"] == 1)
    assert len(stored(site, session_id, epoch=1)) == 5


@pytest.mark.one_engine
def test_frames_of_a_phase_that_does_not_exist_are_doubted(site: Site) -> None:
    """Frames of an unknown phase are stored as received, and put the session in doubt once."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(numbered(0, 9), seq_first=0))
        headset.acknowledged("target", 9)
        assert site.view(session_id)["alarms"] == []
        for first in (9, 18):
            headset.say(message(numbered(first, 9), seq_first=first, phase_id=99))
        headset.acknowledged("target", 27)
    with site.database.reading() as db:
        doubts = doubts_of(db, session_id)
    assert [(one.kind, "phase 99" in one.words) for one in doubts] == [("observed", True)]
    assert stored(site, session_id).seq.tolist() == list(range(27))


def test_an_epoch_that_was_not_assigned_is_refused(site: Site) -> None:
    """A batch with an epoch that was not assigned is refused with the reason."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(numbered(0, 5), epoch=9))
        assert "epoch 9 was not given out" in headset.hear("error")["message"]


@pytest.mark.one_engine
def test_a_malformed_batch_does_not_affect_another_session(site: Site) -> None:
    """A malformed batch closes its own connection; another session's data are still stored."""
    good, bad = site.join(), site.join()
    with site.headset(site.token(good)) as fine, site.headset(site.token(bad)) as broken:
        broken.say(message(numbered(0, 5))[:-1])
        error = broken.hear("error")
        fine.say(message(numbered(0, 5)))
        fine.acknowledged("target", 5)
    assert (error["code"], frames_on_disk(site, bad)) == ("invalid_input", 0)


def test_readers_get_every_frame_once_during_folding(site: Site) -> None:
    """A reader gets every frame once, before, during and after batches are folded into chunks."""
    session_id = site.join()
    deadline_s = time.monotonic() + 15.0
    with site.headset(site.token(session_id)) as headset:
        sent = 0
        while not (chunks(site, session_id) and sent > 200) and time.monotonic() < deadline_s:
            headset.say(message(numbered(sent, 20), seq_first=sent))
            sent += 20
            headset.acknowledged("target", sent)
            assert stored(site, session_id).values[:, 1].tolist() == list(range(sent))
    assert chunks(site, session_id) > 0


def test_a_clock_probe_is_answered_and_stored(site: Site) -> None:
    """A clock probe is answered with the server's clock, and the completed probe is stored."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say({"type": "probe", "client_sent_s": 12.5})
        answer = headset.hear("probe")
        assert answer["client_sent_s"] == 12.5
        assert answer["server_received_ns"] <= answer["server_sent_ns"]
        probed: dict[str, Any] = {**answer, "type": "probed", "client_received_s": 12.75}
        headset.say(probed)
        headset.say(message(numbered(0, 1)))
        headset.acknowledged("target", 1)
    with site.database.reading() as db:
        (row,) = db.scalars(select(ClockProbe).where(ClockProbe.session_id == session_id))
    assert (row.client_sent_s, row.client_received_s) == (12.5, 12.75)
    assert row.server_received_ns == answer["server_received_ns"]


@pytest.mark.one_engine
@pytest.mark.parametrize("epoch", [0, -1, 2**31, "one"])
def test_a_hello_with_an_invalid_epoch_is_refused(site: Site, epoch: object) -> None:
    """A hello with an invalid epoch is refused."""
    with site.socket(site.token(site.join())) as socket:
        headset = Headset(socket)
        headset.say({**HELLO, "epoch": epoch})
        assert "not understood" in headset.hear("error")["message"]


def streams(site: Site, session_id: str) -> list[dict[str, Any]]:
    """Return the streams' positions as the interface lists them, reports last."""
    rows: list[dict[str, Any]] = site.operator.get(f"/api/sessions/{session_id}/streams").json()
    return sorted(rows, key=lambda row: row["stream"] == "reports")


def chunks(site: Site, session_id: str) -> int:
    """Return how many chunks of a session are stored."""
    with site.database.reading() as db:
        query = select(func.count()).select_from(TelemetryChunk)
        return db.scalar(query.where(TelemetryChunk.session_id == session_id)) or 0
