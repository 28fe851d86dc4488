"""Movement over a real socket: acknowledged means on disk, and exactly what was sent."""

import time
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray
from sqlalchemy import func, select

from app.features.record.telemetry.encoding import Frames
from app.features.record.telemetry.frames import concatenate, iter_frames
from app.models import ClockProbe, TelemetryBatch, TelemetryChunk
from app.wire import StreamName
from tests.features.record.headset.site import HELLO, Headset, Site
from tests.wire.samples import bits, every_odd_float, message, standing


def numbered(first: int, count: int) -> NDArray[np.float32]:
    """Frames that tell their own seq in the height of the hips."""
    values = standing(count)
    values[:, 1] = np.arange(first, first + count)
    return values


def stored(site: Site, session_id: str, stream: str = "target", epoch: int = 1) -> Frames:
    """Every frame of a stream as a reader gets it."""
    with site.database.reading() as db:
        return concatenate([frames for _, frames in iter_frames(db, session_id, stream, epoch)])


def frames_on_disk(site: Site, session_id: str) -> int:
    """How many frames are in batches and chunks now."""
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


def test_acknowledged_means_on_disk(site: Site) -> None:
    """Right after each acknowledgement the frames are in the database."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        for first in range(0, 90, 9):
            headset.say(message(numbered(first, 9), seq_first=first))
            headset.acknowledged("target", first + 9)
            assert frames_on_disk(site, session_id) >= first + 9
    assert stored(site, session_id).seq.tolist() == list(range(90))


def test_an_overlap_is_cut(site: Site) -> None:
    """What is stored already is not stored again; the new part is."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(numbered(0, 10)))
        headset.say(message(numbered(5, 10), seq_first=5))
        headset.acknowledged("target", 15)
    frames = stored(site, session_id)
    assert frames.values[:, 1].tolist() == list(range(15))
    assert frames_on_disk(site, session_id) == 15


def test_the_first_content_of_a_seq_stands(site: Site) -> None:
    """A resent seq is acknowledged whatever it holds, and changes nothing."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(numbered(0, 10)))
        headset.acknowledged("target", 10)
        for _ in range(3):
            headset.say(message(numbered(500, 10)))
            headset.acknowledged("target", 10)
    assert stored(site, session_id).values[:, 1].tolist() == list(range(10))


@pytest.mark.one_engine
def test_a_skipped_seq_is_asked_for_again(site: Site) -> None:
    """Nothing behind a hole is stored until the hole is filled."""
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


def test_broken_numbers_are_stored_bit_by_bit_and_flagged(site: Site) -> None:
    """NaN payloads, infinities and denormals come back as they went in, with a notice."""
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
def test_a_rotation_of_another_length_is_flagged_at_its_seq(site: Site) -> None:
    """The notice names the first bad frame, and the others count as sound."""
    session_id = site.join()
    values = standing(10)
    values[7, 3] = 1.5
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(values))
        flag = headset.hear("flag")
    assert (flag["code"], flag["seq"], flag["frames"]) == ("non_unit", 7, 1)


def test_both_streams_have_positions_of_their_own(site: Site) -> None:
    """The target may be ahead of the actual stream."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(numbered(0, 20)))
        headset.say(message(numbered(0, 10), stream=StreamName.ACTUAL))
        headset.acknowledged("actual", 10)
    positions = {row["stream"]: row["next_seq"] for row in streams(site, session_id)}
    assert positions == {"target": 20, "actual": 10, "reports": 0}


def test_a_reconnecting_client_hears_how_far_it_is_stored(site: Site) -> None:
    """The welcome of the same run names the next seq of each stream."""
    session_id = site.join()
    token = site.token(session_id)
    with site.headset(token) as headset:
        headset.say(message(numbered(0, 10)))
        headset.acknowledged("target", 10)
    with site.headset(token, epoch=1) as headset:
        assert headset.epoch == 1
        position = {"stream": "target", "epoch": 1, "next_seq": 10}
        assert position in headset.welcome["positions"]


def test_each_run_of_the_client_has_an_epoch_of_its_own(site: Site) -> None:
    """Two runs that both begin at seq 0 never mix, though the first had sent nothing yet."""
    session_id = site.join()
    token = site.token(session_id)
    with site.headset(token) as first, site.headset(token) as second:
        assert (first.epoch, second.epoch) == (1, 2)
        second.say(message(numbered(100, 5), epoch=2))
        second.acknowledged("target", 5)
        first.say(message(numbered(0, 5), epoch=1))
        first.acknowledged("target", 5)
    assert stored(site, session_id, epoch=1).values[0, 1] == 0
    assert stored(site, session_id, epoch=2).values[0, 1] == 100


@pytest.mark.one_engine
def test_late_frames_of_an_earlier_run_are_taken(site: Site) -> None:
    """What the journal of the run before still held can be sent by the next one."""
    session_id = site.join()
    token = site.token(session_id)
    with site.headset(token):
        pass
    with site.headset(token) as headset:
        headset.say(message(numbered(0, 5), epoch=1))
        headset.hear("ack", lambda ack: ack["positions"][0]["epoch"] == 1)
    assert len(stored(site, session_id, epoch=1)) == 5


@pytest.mark.one_engine
def test_an_epoch_that_was_not_given_out_is_refused(site: Site) -> None:
    """A batch of the future closes the connection with the reason."""
    session_id = site.join()
    with site.headset(site.token(session_id)) as headset:
        headset.say(message(numbered(0, 5), epoch=9))
        assert "epoch 9 was not given out" in headset.hear("error")["message"]


@pytest.mark.one_engine
def test_a_session_that_sends_nonsense_does_not_hold_up_another(site: Site) -> None:
    """A malformed batch closes its own connection; the other session goes on."""
    good, bad = site.join(), site.join()
    with site.headset(site.token(good)) as fine, site.headset(site.token(bad)) as broken:
        broken.say(message(numbered(0, 5))[:-1])
        error = broken.hear("error")
        fine.say(message(numbered(0, 5)))
        fine.acknowledged("target", 5)
    assert (error["code"], frames_on_disk(site, bad)) == ("invalid_input", 0)


def test_readers_meet_every_frame_once_while_folding_goes_on(site: Site) -> None:
    """Chunks and batches together are the stream, before, while and after they are folded."""
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


def test_the_clocks_are_probed(site: Site) -> None:
    """A probe is answered with the server's clock, and the raw reading is stored."""
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
def test_a_hello_with_an_unusable_epoch_is_refused(site: Site, epoch: object) -> None:
    """The first message is checked like any other."""
    with site.socket(site.token(site.join())) as socket:
        headset = Headset(socket)
        headset.say({**HELLO, "epoch": epoch})
        assert "not understood" in headset.hear("error")["message"]


def streams(site: Site, session_id: str) -> list[dict[str, Any]]:
    """The positions as the interface tells them, target first."""
    rows: list[dict[str, Any]] = site.operator.get(f"/api/sessions/{session_id}/streams").json()
    return sorted(rows, key=lambda row: row["stream"] == "reports")


def chunks(site: Site, session_id: str) -> int:
    """How many chunks there are."""
    with site.database.reading() as db:
        query = select(func.count()).select_from(TelemetryChunk)
        return db.scalar(query.where(TelemetryChunk.session_id == session_id)) or 0
