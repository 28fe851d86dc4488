"""Read trackers that a script sends as JSON, one object a datagram (docs/live.md).

    {"source": "my script", "time_s": 12.345, "frame": 7,
     "trackers": {"left foot": {"position_m": [0.1, 0.9, -0.2], "rotation_wxyz": [1, 0, 0, 0]}}}

A tracker with a `parent` is a bone of a skeleton: its pose is in the frame of that other tracker.

Unlike the other doors it has our own frame and units, so nothing is converted. Unknown fields are
refused, because a script with a misspelt field should not appear to work.
"""

from collections import Counter
from dataclasses import replace
from functools import lru_cache
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from app.adapters.live.readings import (
    MAX_POSES,
    BoneDefinition,
    Pose,
    Problem,
    Reading,
    Refused,
    SkeletonDefinition,
    Vector,
    checked_name,
    checked_position,
    checked_rotation,
    checked_time,
)
from app.adapters.live.skeletons import in_order

_MALFORMED = "json_invalid"
_NOWHERE: Vector = (0.0, 0.0, 0.0)


class JsonTracker(BaseModel):
    """A tracker's pose: metres, y up, right-handed; unit quaternion in the order w, x, y, z.

    `parent`: the tracker of the same packet in whose frame the pose is; null for the world.
    """

    model_config = ConfigDict(extra="forbid", strict=True)

    position_m: tuple[float, float, float] | None = None
    rotation_wxyz: tuple[float, float, float, float] | None = None
    tracked: bool = True
    parent: str | None = None


class JsonPacket(BaseModel):
    """A packet of the JSON door; `time_s` and `frame` are by the script's own clock and counter."""

    model_config = ConfigDict(extra="forbid", strict=True)

    source: str
    time_s: float | None = None
    frame: Annotated[int, Field(ge=0, lt=2**63)] | None = None
    trackers: dict[str, JsonTracker]


class JsonTrackers:
    """The decoder of the JSON door; what it reads depends on no other packet."""

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
        poses: dict[str, Pose] = {}
        parents: dict[str, str] = {}
        for name, tracker in sent.trackers.items():
            try:
                if len(poses) >= MAX_POSES:
                    raise Refused("limit")
                pose = _pose(name, tracker)
                poses[pose.tracker] = pose
                if tracker.parent is not None:
                    parents[pose.tracker] = checked_name(tracker.parent)
            except Refused as refused:
                problems[refused.problem] += 1
        skeletons = _skeletons(poses, parents, problems)
        return Reading(tuple(poses.values()), source, time_s, sent.frame, problems, skeletons)


def _skeletons(
    poses: dict[str, Pose], parents: dict[str, str], problems: Counter[Problem]
) -> tuple[SkeletonDefinition, ...]:
    """Return the skeletons of a packet, and mark their bones as such.

    Bones that are below no tracker of the world, because their parent is missing or is below
    themselves, are removed and counted: their pose would mean nothing.
    """
    if not parents:
        return ()
    found = _trees(tuple(poses), tuple(parents.items()))
    reached = {bone.tracker for one in found for bone in one.bones}
    for name in parents.keys() - reached:
        del poses[name]
        problems["arguments"] += 1
    for name in reached:
        poses[name] = replace(poses[name], kind="bone")
    return found


@lru_cache(maxsize=32)
def _trees(
    names: tuple[str, ...], parents: tuple[tuple[str, str], ...]
) -> tuple[SkeletonDefinition, ...]:
    """Return a skeleton for each tracker in the world that is a parent.

    Kept, because packets of a script repeat the same names.
    """
    children: dict[str, list[str]] = {}
    for name, parent in parents:
        children.setdefault(parent, []).append(name)
    bones_below = {name for name, _ in parents}
    found: list[SkeletonDefinition] = []
    for root in (one for one in names if one in children and one not in bones_below):
        waiting, bones = [root], [BoneDefinition(root, None, _NOWHERE)]
        while waiting:
            above = waiting.pop()
            waiting += children.get(above, [])
            bones += [BoneDefinition(one, above, None) for one in children.get(above, [])]
        found.append(SkeletonDefinition(root, in_order(bones), in_parent=True))
    return tuple(found)


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
