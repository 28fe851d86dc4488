"""Read trackers and bones that are sent by OSC: VMC's addresses, and VRChat's.

*VMC* (Virtual Motion Capture protocol 2.x, protocol.vmc.info): `/VMC/Ext/Tra/Pos`, `Hmd`, `Con`,
`Bone` and `Root`: a name, a position, a quaternion x, y, z, w; surplus arguments and unknown
addresses are ignored, as the protocol asks. Bones are in their parent. `/VMC/Ext/T` is the sender's
time in seconds.

*VRChat* ("OSC trackers", docs.vrchat.com): `/tracking/trackers/1` to `8`, or `head`, followed by
`/position` (metres) or `/rotation` (Euler angles in degrees), each in a message of its own.
"""

import re
from collections import Counter

from app.adapters.live.osc import Argument, Message, read_osc
from app.adapters.live.readings import (
    MAX_POSES,
    Kind,
    Pose,
    Problem,
    Quaternion,
    Reading,
    Refused,
    Vector,
    checked_name,
    checked_position,
    checked_rotation,
    checked_time,
)
from app.adapters.live.unity import (
    position_from_unity,
    rotation_from_unity,
    rotation_from_unity_degrees,
)

_VMC: dict[str, Kind] = {
    "/VMC/Ext/Tra/Pos": "tracker",
    "/VMC/Ext/Hmd/Pos": "headset",
    "/VMC/Ext/Con/Pos": "controller",
    "/VMC/Ext/Bone/Pos": "bone",
    "/VMC/Ext/Root/Pos": "root",
}
_VMC_TIME = "/VMC/Ext/T"
_VRCHAT = re.compile(r"/tracking/trackers/([1-8]|head)/(position|rotation)", re.ASCII)
_POSE_ARGUMENTS = 8
_FURTHEST_DEGREES = 1e6


class OscTrackers:
    """The decoder of the OSC door; it keeps nothing between packets."""

    def read(self, packet: bytes) -> Reading:
        """Return the trackers and bones of a packet; never raises."""
        messages, problems = read_osc(packet)
        found = _Found(problems)
        for message in messages:
            try:
                found.take(message)
            except Refused as refused:
                problems[refused.problem] += 1
        return Reading(poses=tuple(found.poses.values()), time_s=found.time_s, problems=problems)


class _Found:
    """The poses of one packet. Two messages about one tracker make one pose, the newer one wins."""

    def __init__(self, problems: Counter[Problem]) -> None:
        self.poses: dict[tuple[Kind, str], Pose] = {}
        self.time_s: float | None = None
        self._problems = problems

    def take(self, message: Message) -> None:
        """Add what a message says; raises Refused."""
        kind = _VMC.get(message.address)
        if kind is not None:
            self._take_vmc(kind, message.arguments)
        elif message.address == _VMC_TIME:
            (self.time_s,) = map(checked_time, _floats(message.arguments, 1))
        elif found := _VRCHAT.fullmatch(message.address):
            self._take_vrchat(found[1], found[2], message.arguments)
        else:
            self._problems["unused"] += 1

    def _take_vmc(self, kind: Kind, arguments: tuple[Argument, ...]) -> None:
        if len(arguments) < _POSE_ARGUMENTS:
            raise Refused("arguments")
        name = checked_name(arguments[0])
        x, y, z, qx, qy, qz, qw = _floats(arguments[1:], 7)
        self._put(
            name,
            kind,
            checked_position(position_from_unity(x, y, z)),
            checked_rotation(*rotation_from_unity(qx, qy, qz, qw)),
        )

    def _take_vrchat(self, number: str, part: str, arguments: tuple[Argument, ...]) -> None:
        kind: Kind = "headset" if number == "head" else "tracker"
        x, y, z = _floats(arguments, 3)
        before = self.poses.get((kind, number))
        position = None if before is None else before.position_m
        rotation = None if before is None else before.rotation
        if part == "position":
            position = checked_position(position_from_unity(x, y, z))
        elif not all(abs(one) <= _FURTHEST_DEGREES for one in (x, y, z)):
            raise Refused("number")
        else:
            rotation = rotation_from_unity_degrees(x, y, z)
        self._put(number, kind, position, rotation)

    def _put(
        self, name: str, kind: Kind, position_m: Vector | None, rotation: Quaternion | None
    ) -> None:
        if len(self.poses) >= MAX_POSES and (kind, name) not in self.poses:
            raise Refused("limit")
        self.poses[kind, name] = Pose(name, kind, position_m, rotation)


def _floats(arguments: tuple[Argument, ...], count: int) -> tuple[float, ...]:
    """Return the first `count` arguments, which must be numbers; surplus ones are ignored."""
    chosen = arguments[:count]
    if len(chosen) < count:
        raise Refused("arguments")
    numbers = tuple(
        float(one) for one in chosen if isinstance(one, int | float) and not isinstance(one, bool)
    )
    if len(numbers) < count:
        raise Refused("arguments")
    return numbers
