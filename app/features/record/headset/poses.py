"""Publish a headset's poses and contacts to consoles, before they are committed.

The feed of one headset's connection publishes the latest frame of each stream at most `RATE_HZ`
times a second, and only while a console is subscribed. A slow console receives only the latest
frame and misses those in between, so it cannot delay the headset (app.platform.hub).

A pose message is little-endian binary:

    offset  type     field
    0       4 bytes  magic "RMP1"
    4       u8       stream: 1 target, 2 actual, 3 and 4 their fingers
    5       u8       frame flags (bit 0: the phase's clock ran)
    6       u16      number of values: 91 for a body, 120 for fingers
    8       u32      phase_id, 0 outside phases
    12      u64      seq of the frame
    20      f64      client monotonic time of the frame, s
    28      f32[91]  body: root position x, y, z (m, world) then 22 local rotations w, x, y, z
            f32[120] fingers: 30 local rotations w, x, y, z
"""

import struct
from collections import deque
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict

from app.platform.hub import Hub
from app.wire import CODE_OF_STREAM, Batch, CompletionReport, ContactReport, Report, StreamName

MAGIC = b"RMP1"
HEADER = struct.Struct("<4sBBHIQd")
RATE_HZ = 30.0
TOPICS = {stream: f"pose_{stream}" for stream in StreamName}
TOUCHES = "touches"
MAX_TOUCHES = 16


class Touch(BaseModel):
    """A contact that has ended, or a completed task (kind `completion`, without surface and part).

    `number` is unique and increases: the epoch and seq of the headset's report.
    """

    model_config = ConfigDict(frozen=True)

    number: tuple[int, int]
    phase_id: int
    kind: Literal["panel", "side", "target", "start", "completion"]
    effect: str
    surface: str | None = None
    part: str | None = None


@dataclass
class PoseFeed:
    """Publishes the poses and contacts of one headset connection to consoles."""

    hub: Hub
    session_id: str
    _published_s: dict[StreamName, float] = field(default_factory=dict)
    _touches: deque[Touch] = field(default_factory=lambda: deque(maxlen=MAX_TOUCHES))

    def take(self, batch: Batch, now_s: float) -> None:
        """Publish the latest frame of a batch received at the server's monotonic time `now_s`."""
        stream = batch.header.stream
        if now_s - self._published_s.get(stream, float("-inf")) < 1.0 / RATE_HZ:
            return
        topic = TOPICS[stream]
        if self.hub.has_listeners(self.session_id, topic):
            self._published_s[stream] = now_s
            self.hub.publish(self.session_id, topic, encode_pose(batch))

    def report(self, report: Report) -> None:
        """Publish a contact or a completed task, together with the last few before it."""
        touch = _touch(report)
        if touch is None:
            return
        self._touches.append(touch)
        self.hub.publish(self.session_id, TOUCHES, tuple(self._touches))


def encode_pose(batch: Batch) -> bytes:
    """Encode the latest frame of a batch as a pose message."""
    header = batch.header
    values = np.ascontiguousarray(batch.values[-1], "<f4")
    return (
        HEADER.pack(
            MAGIC,
            CODE_OF_STREAM[header.stream],
            int(batch.flags[-1]),
            len(values),
            header.phase_id,
            header.seq_end - 1,
            float(batch.times_s[-1]),
        )
        + values.tobytes()
    )


def _touch(report: Report) -> Touch | None:
    body = report.body
    number = (report.epoch, report.seq)
    if isinstance(body, ContactReport):
        return Touch(
            number=number,
            phase_id=body.phase_id,
            surface=body.surface,
            kind=body.surface_kind,
            part=body.body_part,
            effect=body.effect,
        )
    if isinstance(body, CompletionReport):
        return Touch(number=number, phase_id=body.phase_id, kind="completion", effect="completed")
    return None
