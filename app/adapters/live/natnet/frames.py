"""Read a NatNet frame: rigid bodies, skeletons and the time; markers and devices are skipped."""

import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

from app.adapters.live.natnet.fields import Fields
from app.adapters.live.readings import Quaternion, Refused, Vector

_ROW = struct.Struct("<i3f4ffh")
"""Id, position, quaternion x, y, z, w, mean error of the markers, and flags."""
_BONE = 0xFFFF
"""The part of an id that tells a bone; the upper half repeats the skeleton's."""
_END_BYTES = 4  # the frame ends with a zero


@dataclass(frozen=True, slots=True)
class Body:
    """A rigid body or bone of a frame. `owner` is its skeleton's or asset's id, or None."""

    owner: int | None
    identity: int
    position_m: Vector
    rotation: Quaternion
    tracked: bool


@dataclass
class Frame:
    """A frame: Motive's counter and time in seconds, and the bodies in the order of the packet."""

    number: int
    time_s: float = 0.0
    bodies: list[Body] = field(default_factory=list)


def read_frame(fields: Fields) -> Frame:
    """Return the frame; raises Refused if its structure cannot be read to the end."""
    frame = Frame(number=fields.integer())
    version = fields.version
    for _ in _section(fields, 5):
        fields.text()
        fields.skip(12 * fields.count(12))
    for _ in _section(fields, 12):
        fields.skip(12)
    with _counted(fields, 32) as count:
        frame.bodies += _bodies(fields, None, count)
    if version > (2, 0):
        for _ in _section(fields, 8):
            skeleton = fields.integer()
            frame.bodies += _bodies(fields, skeleton, fields.count(32))
    if version >= (4, 1):
        for _ in _section(fields, 12):
            _asset(fields, frame)
    _skip_measurements(fields)
    frame.time_s = _time(fields)
    return frame


def _section(fields: Fields, smallest: int) -> Iterator[int]:
    """Go through the items of a section, which from 4.1 on has its size after the count."""
    with _counted(fields, smallest) as count:
        yield from range(count)


@contextmanager
def _counted(fields: Fields, smallest: int) -> Iterator[int]:
    """Read a section, and give the number of its items."""
    count = fields.integer()
    with fields.sized():
        if not 0 <= count * smallest <= fields.left:
            raise Refused("malformed")
        yield count


def _bodies(fields: Fields, owner: int | None, count: int) -> list[Body]:
    """Read bodies, which from 3.0 on have no markers and so are all of one size."""
    if fields.version < (3, 0):
        return [_body(fields, owner) for _ in range(count)]
    mask = -1 if owner is None else _BONE
    return [
        Body(owner, identity & mask, (px, py, pz), (w, x, y, z), bool(flags & 1))
        for identity, px, py, pz, x, y, z, w, _error, flags in fields.rows(_ROW, count)
    ]


def _body(fields: Fields, owner: int | None) -> Body:
    identity, position, rotation = fields.integer(), fields.vector(), fields.quaternion()
    version = fields.version
    if version < (3, 0):
        # Each marker's position, and from 2.0 on its id and size.
        fields.skip(fields.count(12) * (20 if version >= (2, 0) else 12))
    if version >= (2, 0):
        fields.skip(4)  # mean error of the markers
    # Bit 0 of the parameters, from 2.6 on: whether the body is tracked in this frame. Motive 1.10
    # (NatNet 2.10) leaves it 0 on every bone.
    flag = version < (2, 6) or bool(fields.integer("h") & 1)
    tracked = flag or (owner is not None and version < (3, 0))
    if owner is not None:
        identity &= _BONE
    return Body(owner, identity, position, rotation, tracked)


def _asset(fields: Fields, frame: Frame) -> None:
    identity = fields.integer()
    frame.bodies += _bodies(fields, identity, fields.count(38))
    fields.skip(26 * fields.count(26))


def _skip_measurements(fields: Fields) -> None:
    """Skip labelled markers (from 2.3 on), force plates (2.9) and analogue devices (2.11)."""
    version = fields.version
    if version >= (2, 3):
        size = 20 + (2 if version >= (2, 6) else 0) + (4 if version >= (3, 0) else 0)
        for _ in _section(fields, size):
            fields.skip(size)
    for since in ((2, 9), (2, 11)):
        if version < since:
            break
        for _ in _section(fields, 8):
            fields.integer()
            for _channel in range(fields.count(4)):
                fields.skip(4 * fields.count(4))


def _time(fields: Fields) -> float:
    version = fields.version
    if version < (3, 0):
        fields.skip(4)  # the software's latency
    fields.skip(8)  # the time code
    time_s = fields.numbers("d" if version >= (2, 7) else "f")[0]
    if version >= (3, 0):
        fields.skip(3 * 8)  # exposure, arrival and sending, by the server's fast clock
    if version >= (4, 1):
        fields.skip(8)  # the precision time
    fields.skip(2 + _END_BYTES)
    if fields.left:
        raise Refused("malformed")
    return time_s
