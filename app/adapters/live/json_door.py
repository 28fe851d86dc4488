"""Read trackers that a script sends as JSON, one object a datagram (docs/live.md).

    {"source": "my script", "time_s": 12.345, "frame": 7,
     "trackers": {"left foot": {"position_m": [0.1, 0.9, -0.2], "rotation_wxyz": [1, 0, 0, 0]}}}

Unlike the other doors it has our own frame and units, so nothing is converted. Unknown fields are
refused, because a script with a misspelt field should not appear to work.
"""

from collections import Counter
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from app.adapters.live.readings import (
    MAX_POSES,
    Pose,
    Problem,
    Reading,
    Refused,
    checked_name,
    checked_position,
    checked_rotation,
    checked_time,
)

_MALFORMED = "json_invalid"


class JsonTracker(BaseModel):
    """A tracker's pose: metres, y up, right-handed; unit quaternion in the order w, x, y, z."""

    model_config = ConfigDict(extra="forbid", strict=True)

    position_m: tuple[float, float, float] | None = None
    rotation_wxyz: tuple[float, float, float, float] | None = None
    tracked: bool = True


class JsonPacket(BaseModel):
    """A packet of the JSON door; `time_s` and `frame` are by the script's own clock and counter."""

    model_config = ConfigDict(extra="forbid", strict=True)

    source: str
    time_s: float | None = None
    frame: Annotated[int, Field(ge=0, lt=2**63)] | None = None
    trackers: dict[str, JsonTracker]


class JsonTrackers:
    """The decoder of the JSON door; it keeps nothing between packets."""

    def read(self, packet: bytes) -> Reading:
        """Return the trackers of a packet; never raises."""
        problems: Counter[Problem] = Counter()
        try:
            sent = JsonPacket.model_validate_json(packet)
            source = checked_name(sent.source)
            time_s = None if sent.time_s is None else checked_time(sent.time_s)
        except ValidationError as error:
            first = error.errors(include_url=False, include_context=False, include_input=False)[0]
            problems["malformed" if first["type"] == _MALFORMED else "arguments"] += 1
            return Reading(problems=problems)
        except Refused as refused:
            problems[refused.problem] += 1
            return Reading(problems=problems)
        poses: list[Pose] = []
        for name, tracker in sent.trackers.items():
            try:
                if len(poses) >= MAX_POSES:
                    raise Refused("limit")
                poses.append(_pose(name, tracker))
            except Refused as refused:
                problems[refused.problem] += 1
        return Reading(tuple(poses), source, time_s, sent.frame, problems)


def _pose(name: str, tracker: JsonTracker) -> Pose:
    position, rotation = tracker.position_m, tracker.rotation_wxyz
    if position is None and rotation is None:
        raise Refused("arguments")
    return Pose(
        tracker=checked_name(name),
        kind="tracker",
        position_m=None if position is None else checked_position(position),
        rotation=None if rotation is None else checked_rotation(*rotation),
        tracked=tracker.tracked,
    )
