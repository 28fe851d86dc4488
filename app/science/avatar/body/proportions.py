"""Compute the length of every bone of one person: the 52 parts in the T-pose.

The 22 body joints are those of `app.science.skeleton.build_skeleton`: lengths as fractions of the
stature. A measured length, given by its name, replaces the fraction on both sides; the height of
the hips then follows from the length of the legs. Finger lengths follow from the length of the
hand; see `fingers`.

Estimated by us: the heel is a quarter of the foot's length behind the ankle.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from app.science.avatar.body.fingers import HAND_BREADTH, finger_bones
from app.science.avatar.body.parts import PARENT_OF, PART_NAMES, SIDES
from app.science.rotations import Vector, v_add
from app.science.skeleton import JOINT_INDEX, Skeleton, SkeletonError, build_skeleton

_FOOT_LENGTH, _BEHIND_THE_ANKLE = 0.152, 0.25
MIN_RATIO, MAX_RATIO = 0.7, 1.3
"""Permitted range of a measured length, as a multiple of the one expected for the stature."""

SEGMENT_NAMES: tuple[str, ...] = (
    "upper_arm", "forearm", "hand", "thigh", "shank", "foot", "trunk", "head", "shoulders", "hips",
)  # fmt: skip
"""Names of the lengths that can be measured; see `segment_lengths`."""


class BodyError(ValueError):
    """A body cannot be built: an impossible length or mass, or a missing required part."""


@dataclass(frozen=True)
class Proportions:
    """Bones of all 52 parts in the T-pose, metres; frames as in `app.science.avatar.body.parts`.

    Attributes:
        stature_m: body height.
        joints_m: each part's joint in its parent's frame; for the hips, their position above the
            floor.
        ends_m: end of each part's bone in the part's frame: the next joint, or the tip.
        radii_m: half the thickness of each part.
        segments_m: the lengths in use, by the names of `SEGMENT_NAMES`.
    """

    stature_m: float
    joints_m: Mapping[str, Vector]
    ends_m: Mapping[str, Vector]
    radii_m: Mapping[str, float]
    segments_m: Mapping[str, float]

    @property
    def hand_breadth_m(self) -> float:
        """Return the breadth of the palm at the knuckles."""
        return HAND_BREADTH * self.segments_m["hand"]

    @property
    def heel_m(self) -> float:
        """Return the distance of the heel behind the ankle."""
        return _BEHIND_THE_ANKLE * self.segments_m["foot"]

    @property
    def ankle_height_m(self) -> float:
        """Return the height of the ankle above the sole of a flat foot."""
        return 0.039 * self.stature_m

    def places_m(self) -> dict[str, Vector]:
        """Return the position of each joint in the world in the T-pose, feet on the floor."""
        places: dict[str, Vector] = {}
        for part in PART_NAMES:
            parent = PARENT_OF[part]
            offset = self.joints_m[part]
            places[part] = offset if parent is None else v_add(places[parent], offset)
        return places


def segment_lengths(stature_m: float) -> dict[str, float]:
    """Return the lengths expected for a stature; measured ones may replace them.

    `upper_arm`, `forearm`, `thigh` and `shank` are measured from joint to joint; `hand` from the
    wrist to the tip of the middle finger; `foot` from heel to toes; `trunk` from the hips joint to
    the base of the neck; `head` from there to the top of the head; `shoulders` and `hips` from the
    left to the right shoulder joint and hip joint.

    Raises:
        BodyError: the stature is not between 0.5 and 2.6 m.
    """
    return _expected(_skeleton(stature_m))


def proportions(
    stature_m: float, segments_m: Mapping[str, float] = MappingProxyType({})
) -> Proportions:
    """Return the bones of a person of this stature, with measured lengths where given.

    Raises:
        BodyError: the stature is out of range, a segment's name is unknown, or a length is not
            between 0.7 and 1.3 times the one expected for the stature.
    """
    skeleton = _skeleton(stature_m)
    expected = _expected(skeleton)
    _check(expected, segments_m)
    lengths = {**expected, **segments_m}
    ratios = {name: lengths[name] / expected[name] for name in SEGMENT_NAMES}
    joints, ends = _body(skeleton, ratios)
    radii = {part: float(skeleton.radii_m[index]) for part, index in JOINT_INDEX.items()}
    radii["Head"] *= ratios["head"]
    for side in SIDES:
        for bone in finger_bones(side, lengths["hand"]):
            joints[bone.part], ends[bone.part] = bone.joint_m, bone.end_m
            radii[bone.part] = stature_m * bone.relative_radius
        ends[f"{side}Hand"] = joints[f"{side}MiddleProximal"]
    return Proportions(
        stature_m,
        MappingProxyType({part: joints[part] for part in PART_NAMES}),
        MappingProxyType({part: ends[part] for part in PART_NAMES}),
        MappingProxyType(radii),
        MappingProxyType(lengths),
    )


def _skeleton(stature_m: float) -> Skeleton:
    try:
        return build_skeleton(stature_m)
    except SkeletonError as error:
        raise BodyError(str(error)) from error


def _expected(skeleton: Skeleton) -> dict[str, float]:
    offsets, ends = skeleton.offsets_m, skeleton.ends_m
    upper_leg, upper_arm = JOINT_INDEX["RightUpperLeg"], JOINT_INDEX["RightUpperArm"]
    trunk = ("Spine", "Chest", "UpperChest", "Neck")
    shoulder = offsets[JOINT_INDEX["RightShoulder"], 0] + offsets[upper_arm, 0]
    return {
        "upper_arm": skeleton.length_m("LeftLowerArm"),
        "forearm": skeleton.length_m("LeftHand"),
        "hand": abs(float(ends[JOINT_INDEX["LeftHand"], 0])),
        "thigh": skeleton.length_m("LeftLowerLeg"),
        "shank": skeleton.length_m("LeftFoot"),
        "foot": _FOOT_LENGTH * skeleton.stature_m,
        "trunk": sum(skeleton.length_m(part) for part in trunk),
        "head": skeleton.length_m("Head") + float(ends[JOINT_INDEX["Head"], 1]),
        "shoulders": 2.0 * float(shoulder),
        "hips": 2.0 * float(offsets[upper_leg, 0]),
    }


def _check(expected: Mapping[str, float], segments_m: Mapping[str, float]) -> None:
    for name, length in segments_m.items():
        if name not in expected:
            raise BodyError(
                f"There is no segment {name!r}: give lengths only for {', '.join(SEGMENT_NAMES)}."
            )
        low, high = MIN_RATIO * expected[name], MAX_RATIO * expected[name]
        if not low <= length <= high:
            raise BodyError(
                f"{name} {length} m does not fit the stature: it must be between {low:.3f} and"
                f" {high:.3f} m. Check the unit (metres) and what was measured."
            )


# Which axes of a joint's offset each measured length stretches: (segment for x, y, z).
_STRETCH: Mapping[str, tuple[str | None, str | None, str | None]] = {
    "Spine": (None, "trunk", None),
    "Chest": (None, "trunk", None),
    "UpperChest": (None, "trunk", None),
    "Neck": (None, "trunk", None),
    "Head": (None, "head", None),
    "Shoulder": ("shoulders", "trunk", None),
    "UpperArm": ("shoulders", None, None),
    "LowerArm": ("upper_arm", None, None),
    "Hand": ("forearm", None, None),
    "UpperLeg": ("hips", None, None),
    "LowerLeg": (None, "thigh", None),
    "Foot": (None, "shank", None),
    "Toes": (None, None, "foot"),
}


def _body(
    skeleton: Skeleton, ratios: Mapping[str, float]
) -> tuple[dict[str, Vector], dict[str, Vector]]:
    joints: dict[str, Vector] = {}
    ends: dict[str, Vector] = {}
    for part, index in JOINT_INDEX.items():
        base = part.removeprefix("Left").removeprefix("Right")
        joints[part] = _stretched(skeleton.offsets_m[index].tolist(), base, ratios)
        # A bone ends at the next joint; tips of hand, head and toes scale with their own segment.
        segment = {"Hand": "hand", "Head": "head", "Toes": "foot"}.get(base)
        x, y, z = skeleton.ends_m[index].tolist()
        ratio = ratios[segment] if segment else 1.0
        ends[part] = (x * ratio, y * ratio, z * ratio)
    _lift_hips(skeleton, ratios, joints)
    for part in JOINT_INDEX:
        parent = PARENT_OF[part]
        if parent is not None and not part.endswith(("Shoulder", "UpperLeg")):
            ends[parent] = joints[part]
    return joints, ends


def _lift_hips(skeleton: Skeleton, ratios: Mapping[str, float], joints: dict[str, Vector]) -> None:
    x, y, z = joints["Hips"]
    thigh = skeleton.length_m("LeftLowerLeg") * (ratios["thigh"] - 1.0)
    shank = skeleton.length_m("LeftFoot") * (ratios["shank"] - 1.0)
    joints["Hips"] = (x, y + thigh + shank, z)


def _stretched(offset: list[float], base: str, ratios: Mapping[str, float]) -> Vector:
    by = _STRETCH.get(base, (None, None, None))
    x, y, z = (
        value if name is None else value * ratios[name]
        for value, name in zip(offset, by, strict=True)
    )
    return (x, y, z)
