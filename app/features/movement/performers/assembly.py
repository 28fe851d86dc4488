"""Put the poses of a source's bones together into frames of one skeleton.

Everything here is a function of samples: no clock is read. Three kinds of sources differ in what
they tell:

- VMC sends the bones of a Unity avatar, each in its parent, and not who the parent is, which the
  names tell. A frame may come in several packets, so the bones that belong to one are learned from
  the first that repeat.
- NatNet tells bones with parents and offsets, but not whether poses are in the parent or in the
  world: whichever agrees better with the offsets is taken.
- The door for scripts tells all of it with every packet.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from app.adapters.captures import safe_names
from app.adapters.live import Pose, SkeletonDefinition, human_skeleton
from app.features.movement.live import Sample
from app.science.rig import BoolArray, Rig, to_local
from app.science.rotations import FloatArray, conjugate, identity, multiply, normalise, rotate

Sent = tuple[str, SkeletonDefinition | None]
"""The name of a skeleton, and its definition; none for the bones of a Unity avatar."""
CHECKED_S = 1.0
"""How often it is checked whether offsets have changed, and in which frame poses are."""
SAME_M = 0.005
"""Bones whose offsets changed by no more than this are the same skeleton."""


@dataclass(frozen=True, eq=False, slots=True)
class Skeleton:
    """A skeleton whose bones have all been seen.

    Attributes:
        rig: the bones in the order of a BVH file, with names that one can have; not rotated at
            rest.
        in_parent: whether its poses come in the parent's frame; else in the world.
    """

    rig: Rig
    in_parent: bool


@dataclass(frozen=True, eq=False, slots=True)
class BodyFrame:
    """A skeleton at one moment.

    Attributes:
        number: counts the frames of the skeleton's source, from 1.
        skeleton: the skeleton that it is a pose of.
        root_m, rotations: (3,) and (J, 4), as in `RigMotion`.
        observed: (J,) false for bones whose pose is old, because it was lost or not sent.
        source_s, arrival_s, mapped_s: as in `Sample`.
    """

    number: int
    skeleton: Skeleton
    root_m: FloatArray
    rotations: FloatArray
    observed: BoolArray
    source_s: float | None
    arrival_s: float
    mapped_s: float


class Assembly:
    """Makes the frames of one skeleton of one source.

    Attributes:
        skeleton: None until every bone was seen.
        missing: bones without a pose so far; of those without an offset, the position is missing.
    """

    def __init__(self) -> None:
        self.skeleton: Skeleton | None = None
        self.missing: tuple[str, ...] = ()
        self._definition: SkeletonDefinition | None = None
        self._learned = False
        self._latest: dict[str, Pose] = {}
        self._fresh: set[str] = set()
        self._began: Sample | None = None
        self._whole_s = 0.0
        self._root: Pose | None = None
        self._checked_s = float("-inf")
        self._number = 0

    @property
    def trackers(self) -> tuple[str, ...]:
        """The bones by the names that the source gives them, in the order of the rig."""
        definition = self._definition
        return () if definition is None else tuple(one.tracker for one in definition.bones)

    def take(self, sample: Sample, definition: SkeletonDefinition | None) -> list[BodyFrame]:
        """Take a packet; return the frames that are complete with it, the older first.

        `definition`: the skeleton as the source defines it, whose frames come whole; None for the
        bones of a Unity avatar.
        """
        if definition is not None:
            self._define(definition)
            names = {one.tracker for one in definition.bones}
            self._note(one for one in sample.poses if one.tracker in names)
            return self._frames(sample)
        bones = [one for one in sample.poses if one.kind == "bone"]
        self._root = next((one for one in sample.poses if one.kind == "root"), self._root)
        frames: list[BodyFrame] = []
        if any(one.tracker in self._fresh for one in bones):
            frames = self._end_of_repeated(sample)
        self._note(bones)
        self._began = sample
        if self._learned and self._definition is not None:
            expected = {one.tracker for one in self._definition.bones}
            if expected <= self._fresh:
                self._whole_s = sample.arrival_s
                if self._has_news(expected):
                    self._learn(self._fresh)
                frames += self._frames(sample)
        return frames

    def _end_of_repeated(self, sample: Sample) -> list[BodyFrame]:
        """End the frame before a packet that repeats a bone; usually it was complete, and ended."""
        began = self._began
        if began is None:
            return []
        if not self._learned or sample.arrival_s - self._whole_s > CHECKED_S:
            # The first frame, or a bone that others do not have any more.
            self._learned, self._whole_s = True, sample.arrival_s
            self._learn(self._fresh)
        return self._frames(began)

    def _has_news(self, expected: set[str]) -> bool:
        more = human_skeleton(self._fresh - expected | {"Hips"})
        return more is not None and len(more.bones) > 1

    def _learn(self, names: set[str]) -> None:
        found = human_skeleton(names)
        if found is not None:
            self._define(found)

    def _define(self, definition: SkeletonDefinition) -> None:
        if definition is self._definition or definition == self._definition:
            return
        self._definition, self.skeleton = definition, None
        self._checked_s = float("-inf")
        self.missing = tuple(one.tracker for one in definition.bones)

    def _note(self, poses: Iterable[Pose]) -> None:
        for pose in poses:
            before = self._latest.get(pose.tracker)
            if before is not None and (pose.position_m is None or pose.rotation is None):
                whole = replace(
                    pose,
                    position_m=pose.position_m or before.position_m,
                    rotation=pose.rotation or before.rotation,
                )
                self._latest[pose.tracker] = whole
            else:
                self._latest[pose.tracker] = pose
            self._fresh.add(pose.tracker)

    def _frames(self, sample: Sample) -> list[BodyFrame]:
        """Return the frame of the newest poses, if every bone has one; what follows is another."""
        fresh, self._fresh = self._fresh, set()
        self._began = None
        definition = self._definition
        if definition is None or not fresh:
            return []
        if self.skeleton is None and not self._is_seen(definition):
            return []
        found = [self._latest[one.tracker] for one in definition.bones]
        turned = np.array([one.rotation for one in found], dtype=np.float64)
        # Bones that never said where they are hang on those that define their offset.
        places = np.array([one.position_m or _NOWHERE for one in found], dtype=np.float64)
        if sample.arrival_s - self._checked_s >= CHECKED_S:
            self._checked_s = sample.arrival_s
            self._check(definition, places, turned)
        if self.skeleton is None:
            return []
        rig = self.skeleton.rig
        if self.skeleton.in_parent:
            root_m, rotations = self._in_root(places[0], normalise(turned))
        else:
            root_m, rotations = places[0], to_local(rig, turned)
        self._number += 1
        return [
            BodyFrame(
                self._number,
                self.skeleton,
                root_m,
                rotations,
                np.array([one.tracked and one.tracker in fresh for one in found]),
                sample.source_s,
                sample.arrival_s,
                sample.mapped_s,
            )
        ]

    def _in_root(self, place: FloatArray, turned: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Bring the hips of a Unity avatar, which are in its root, into the world."""
        root = self._root
        if root is None or root.position_m is None or root.rotation is None:
            return place, turned
        world_from_root = normalise(np.array(root.rotation))
        turned[0] = multiply(world_from_root, turned[0])
        return np.array(root.position_m) + rotate(world_from_root, place), turned

    def _is_seen(self, definition: SkeletonDefinition) -> bool:
        """Return whether every bone has a rotation and an offset, and the root a place."""

        def lacks(tracker: str, *, place: bool) -> bool:
            pose = self._latest.get(tracker)
            return pose is None or pose.rotation is None or (place and pose.position_m is None)

        self.missing = tuple(
            one.tracker
            for one in definition.bones
            if lacks(one.tracker, place=one.parent is None or one.offset_m is None)
        )
        return not self.missing

    def _check(
        self, definition: SkeletonDefinition, places: FloatArray, turned: FloatArray
    ) -> None:
        """Make the skeleton, or make it anew if its offsets or the frame of its poses changed."""
        order = {one.tracker: at for at, one in enumerate(definition.bones)}
        parents = tuple(-1 if one.parent is None else order[one.parent] for one in definition.bones)
        offsets = places.copy()
        for at, one in enumerate(definition.bones):
            if one.offset_m is not None:
                offsets[at] = one.offset_m
        offsets[0] = 0.0
        in_parent = definition.in_parent
        if in_parent is None:
            in_parent = _are_in_parent(parents, offsets, places, turned)
        known = self.skeleton
        if (
            known is not None
            and known.in_parent == in_parent
            and float(np.abs(known.rig.offsets_m - offsets).max()) <= SAME_M
        ):
            return
        names = safe_names(tuple(one.tracker for one in definition.bones))
        self.skeleton = Skeleton(Rig(names, parents, offsets, identity(len(names))), in_parent)


def skeletons_in(sample: Sample) -> list[Sent]:
    """Return the skeletons of which a packet has a bone."""
    if sample.door == "osc":
        return [("", None)] if any(one.kind == "bone" for one in sample.poses) else []
    sent = {one.tracker for one in sample.poses}
    return [
        (one.name, one)
        for one in sample.skeletons
        if any(bone.tracker in sent for bone in one.bones)
    ]


_NOWHERE = (0.0, 0.0, 0.0)


def _are_in_parent(
    parents: tuple[int, ...], offsets: FloatArray, places: FloatArray, turned: FloatArray
) -> bool:
    """Return whether poses agree better with the offsets in the parent's frame than in the world.

    In the parent's frame a bone is where its offset says; in the world it is there as seen from its
    parent. Most of the bones decide, because some are off in either.
    """
    above = list(parents[1:])
    own = offsets[1:]
    seen = rotate(conjugate(normalise(turned[above])), places[1:] - places[above])
    by_parent = np.linalg.norm(places[1:] - own, axis=-1)
    by_world = np.linalg.norm(seen - own, axis=-1)
    return len(above) == 0 or float(np.median(by_parent)) <= float(np.median(by_world))
