"""What a NatNet client knows of its server: version and names, without which frames mean little."""

import struct
from collections import Counter

from app.adapters.live.natnet.definitions import Definitions, read_definitions
from app.adapters.live.natnet.fields import Fields
from app.adapters.live.natnet.frames import Body, Frame, read_frame
from app.adapters.live.natnet.requests import (
    FRAME,
    MODEL_DEFINITIONS,
    NAME_BYTES,
    NEWEST,
    SERVER_INFO,
)
from app.adapters.live.readings import (
    MAX_NAME,
    MAX_POSES,
    Pose,
    Problem,
    Reading,
    Refused,
    SkeletonDefinition,
    checked_position,
    checked_rotation,
    checked_time,
)

_OLDEST = (2, 0)
_HEADER = struct.Struct("<HH")


class NatNetClient:
    """The decoder of one server's packets.

    It keeps the version and the name that the server has told, and the names of rigid bodies and
    bones; a body without a definition is named by its number. Frames before the version is known
    are counted as `version` and not guessed at.
    """

    def __init__(self) -> None:
        self.version: tuple[int, int] | None = None
        self.server = ""
        self.definitions = Definitions()
        self._skeletons: tuple[SkeletonDefinition, ...] = ()
        self.unnamed = False
        """Whether a frame had a body that the definitions do not name: ask for them again."""

    def read(self, packet: bytes) -> Reading:
        """Return what a packet says of bodies, if it is a frame; never raises."""
        problems: Counter[Problem] = Counter()
        try:
            return self._read(packet, problems)
        except Refused as refused:
            problems[refused.problem] += 1
            return Reading(source=self.server, problems=problems)

    def _read(self, packet: bytes, problems: Counter[Problem]) -> Reading:
        if len(packet) < _HEADER.size:
            raise Refused("malformed")
        message, size = _HEADER.unpack_from(packet)
        body = packet[_HEADER.size :]
        if message == SERVER_INFO:
            self._take_server(body)
        elif message not in (MODEL_DEFINITIONS, FRAME):
            problems["unused"] += 1
        elif self.version is None or not _OLDEST <= self.version <= NEWEST:
            raise Refused("version")
        elif size != len(body):
            raise Refused("malformed")
        elif message == MODEL_DEFINITIONS:
            self.definitions, self.unnamed = read_definitions(Fields(body, self.version)), False
            self._skeletons = tuple(self.definitions.skeletons)
            problems.update(self.definitions.problems)
        else:
            return self._reading(read_frame(Fields(body, self.version)), problems)
        return Reading(source=self.server, problems=problems)

    def _take_server(self, body: bytes) -> None:
        """Read name, version of the application, version of NatNet; the rest is not needed."""
        if len(body) < NAME_BYTES + 8:
            raise Refused("malformed")
        name = body[:NAME_BYTES].partition(b"\0")[0].decode(errors="replace")
        self.server = "".join(one for one in name if one.isprintable())[:MAX_NAME].strip()
        version = (body[NAME_BYTES + 4], body[NAME_BYTES + 5])
        # A newer server was asked for the newest version that we read (`connect_request`).
        self.version = min(version, NEWEST)
        if version < _OLDEST:
            raise Refused("version")

    def _reading(self, frame: Frame, problems: Counter[Problem]) -> Reading:
        time_s = checked_time(frame.time_s)
        poses: list[Pose] = []
        for body in frame.bodies:
            try:
                if len(poses) >= MAX_POSES:
                    raise Refused("limit")
                poses.append(self._pose(body))
            except Refused as refused:
                # A body that was never seen has no rotation: its quaternion is zero.
                problems["unused" if not body.tracked else refused.problem] += 1
        return Reading(
            tuple(poses), self.server, time_s, frame.number, problems, skeletons=self._skeletons
        )

    def _pose(self, body: Body) -> Pose:
        if body.owner is None:
            kind, names = "rigid_body", self.definitions.rigid_bodies
        else:
            kind, names = "bone", self.definitions.bones.get(body.owner, {})
        name = names.get(body.identity)
        if name is None:
            self.unnamed = True
            owner = "" if body.owner is None else f"{body.owner}."
            name = f"{owner}{body.identity}"
        return Pose(
            tracker=name,
            kind="rigid_body" if kind == "rigid_body" else "bone",
            position_m=checked_position(body.position_m),
            rotation=checked_rotation(*body.rotation),
            tracked=body.tracked,
        )
