"""A motion capture suit as trackers: on which limbs its bones are, and where they are in the room.

Bones are sent in their parents, so they are put together first. Which bone is on which limb need
not be said by people: it follows from their names, as for performers.
"""

from collections.abc import Collection
from dataclasses import dataclass, field

from sqlalchemy.orm import Session

from app.adapters.live import Pose
from app.features.movement.live import Sample
from app.features.movement.performers import Assembly, Performers, joint_map_of, skeletons_in
from app.science.rig import to_world
from app.wire import GOALS

MOST_SKELETONS = 8
"""The most skeletons of one source that are put together."""


def bone_limbs(db: Session, performers: Performers, door: str, source: str) -> dict[str, str]:
    """Return which bones of a source are on limbs of the headset's, by the source's name of each.

    Empty unless the source sends one skeleton that can be used: of several, nobody knows which is
    the participant's.
    """
    names = {one.name for one in performers.all()}
    own = [one for one in names if (one.door, one.source) == (door, source)]
    if len(own) != 1:
        return {}
    performer, _ = performers.used(own[0])
    agreed = None if performer is None else performer.agreed
    if performer is None or agreed is None:
        return {}
    joint_map, problems = joint_map_of(db, agreed.rig)
    trackers = dict(zip(agreed.rig.names, performer.trackers, strict=False))
    if problems:
        return {}
    return {trackers[joint]: limb for limb, joint in joint_map.items() if limb in GOALS}


@dataclass
class WornBones:
    """Puts the bones of a source together, and says where those that are worn are."""

    _assemblies: dict[str, Assembly] = field(default_factory=dict)

    def of(self, sample: Sample, worn: Collection[str]) -> list[Pose]:
        """Return where the worn bones of a packet are in the source's world; none before a frame.

        Each stands for a tracker at the bone's joint; a bone that its source lost is not tracked.
        """
        found: list[Pose] = []
        for name, definition in skeletons_in(sample) if worn else ():
            if name not in self._assemblies and len(self._assemblies) >= MOST_SKELETONS:
                continue
            assembly = self._assemblies.setdefault(name, Assembly())
            for frame in assembly.take(sample, definition)[-1:]:
                rig = frame.skeleton.rig
                places, rotations = to_world(rig, frame.root_m, frame.rotations)
                found += [
                    Pose(
                        tracker,
                        "tracker",
                        (float(x), float(y), float(z)),
                        (float(qw), float(qx), float(qy), float(qz)),
                        tracked=bool(tracked),
                    )
                    for tracker, (x, y, z), (qw, qx, qy, qz), tracked in zip(
                        assembly.trackers, places, rotations, frame.observed, strict=True
                    )
                    if tracker in worn
                ]
        return found
