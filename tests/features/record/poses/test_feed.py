"""Tests of the pose feed: the newest frame, at a limited rate, only while a console watches."""

import asyncio
import struct

import numpy as np

from app.features.record.headset.poses import (
    HEADER,
    MAGIC,
    MAX_TOUCHES,
    TOUCHES,
    PoseFeed,
    encode_pose,
)
from app.features.record.poses.endpoints import visible
from app.platform.hub import Hub
from app.wire import Batch, StreamName, decode_batch
from app.wire.messages import CompletionReport, ContactReport, Report
from tests.wire.samples import message, standing


def batch(seq: int, stream: StreamName = StreamName.TARGET) -> Batch:
    """Return a batch of six frames in which the hips' x is the frame's seq."""
    values = standing(6)
    values[:, 0] = seq + np.arange(6)
    return decode_batch(message(values, stream=stream, seq_first=seq, phase_id=3, active=True))


def contact(seq: int) -> Report:
    """Return a report of a touched panel."""
    body = ContactReport(
        phase_id=3,
        surface="hand/1/panel",
        surface_kind="panel",
        box=1,
        body_part="RightHand",
        begin_s=1.0,
        end_s=1.1,
        begin_active_s=1.0,
        end_active_s=1.1,
        effect="green",
    )
    return Report(epoch=1, seq=seq, body=body)


def test_a_pose_is_the_newest_frame_of_its_batch() -> None:
    """A pose message has the newest frame of its batch, bit by bit, after the documented header."""
    reported = encode_pose(batch(12, StreamName.ACTUAL))
    assert len(reported) == HEADER.size + 4 * 91
    magic, stream, flags, count, phase_id, seq, t_s = struct.unpack_from("<4sBBHIQd", reported)
    assert (magic, stream, flags, count, phase_id, seq) == (MAGIC, 2, 1, 91, 3, 17)
    assert t_s == 17 / 90.0
    assert np.array_equal(np.frombuffer(reported, "<f4", 91, HEADER.size), batch(12).values[-1])


def test_a_slow_console_gets_only_the_newest_pose() -> None:
    """A slow console gets only the newest pose, and the feed never waits for it."""

    async def run() -> dict[str, bytes]:
        hub = Hub()
        feed = PoseFeed(hub, "s")
        feed.take(batch(0), 1.0)
        with hub.subscribe("s", "pose_target", TOUCHES) as slow:
            for turn in range(50):
                feed.take(batch(6 * turn), 2.0 + 0.1 * turn)
            await asyncio.sleep(0)
            return await slow.next(1.0)

    news = asyncio.run(run())
    assert list(news) == ["pose_target"]
    assert HEADER.unpack_from(news["pose_target"])[5] == 6 * 49 + 5


def test_poses_are_sent_at_most_thirty_times_a_second() -> None:
    """Poses of a stream are sent at most thirty times a second."""

    async def run() -> int:
        hub = Hub()
        feed = PoseFeed(hub, "s")
        drawn = 0
        with hub.subscribe("s", "pose_target") as console:
            for turn in range(100):
                feed.take(batch(6 * turn), 0.01 * turn)
                await asyncio.sleep(0)
                drawn += len(await console.next(0.001))
        return drawn

    assert 20 <= asyncio.run(run()) <= 31


def test_recent_touches_are_sent_together() -> None:
    """The most recent touches and completed tasks are sent together, numbered, oldest first."""

    async def run() -> list[tuple[int, int]]:
        hub = Hub()
        feed = PoseFeed(hub, "s")
        with hub.subscribe("s", TOUCHES) as console:
            for seq in range(20):
                feed.report(contact(seq))
            done = CompletionReport(
                phase_id=3,
                number=1,
                t_s=2.0,
                active_s=2.0,
                duration_s=2.0,
                order=(1,),
                out_of_order_touches=0,
            )
            feed.report(Report(epoch=1, seq=20, body=done))
            await asyncio.sleep(0)
            touches = (await console.next(1.0))[TOUCHES]
            assert touches[-1].kind == "completion"
            return [touch.number for touch in touches]

    assert asyncio.run(run()) == [(1, seq) for seq in range(21 - MAX_TOUCHES, 21)]


def test_a_blinded_console_gets_only_the_participants_pose() -> None:
    """A blinded console gets only the participant's pose, as the avatar reveals the latency."""
    feed_news = {"pose_target": b"t", "pose_actual": b"a", TOUCHES: ()}
    assert list(visible(feed_news, blinded=True)) == [b"t"]
    shown = list(visible(feed_news, blinded=False))
    assert shown[:2] == [b"t", b"a"]
    assert len(shown) == 3
