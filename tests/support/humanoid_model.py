"""A synthetic humanoid model: its bones, their positions, and the skin around them.

It has the joints of a person of 1.7 m with shorter arms and shoulders further back, and a box of
skin around each bone.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import FINGER_PARTS, PART_NAMES, proportions

Array = npt.NDArray[np.float64]
STATURE_M = 1.7
_SHOULDERS_BACK_M, _ARMS = 0.02, 0.93
MIXAMO: Mapping[str, str] = {
    "Hips": "Hips", "Spine": "Spine", "Chest": "Spine1", "UpperChest": "Spine2", "Neck": "Neck",
    "Head": "Head", "Shoulder": "Shoulder", "UpperArm": "Arm", "LowerArm": "ForeArm",
    "Hand": "Hand", "UpperLeg": "UpLeg", "LowerLeg": "Leg", "Foot": "Foot", "Toes": "ToeBase",
    "Little": "Pinky", "Proximal": "1", "Intermediate": "2", "Distal": "3",
}  # fmt: skip


def mixamo_name(part: str) -> str:
    """Return Mixamo's name of a part: `mixamorig:LeftHandIndex1` for `LeftIndexProximal`."""
    side = next((side for side in ("Left", "Right") if part.startswith(side)), "")
    bare = part.removeprefix(side)
    if part not in FINGER_PARTS:
        return f"mixamorig:{side}{MIXAMO[bare]}"
    segment = next(one for one in ("Proximal", "Intermediate", "Distal") if bare.endswith(one))
    finger = bare.removesuffix(segment)
    return f"mixamorig:{side}Hand{MIXAMO.get(finger, finger)}{MIXAMO[segment]}"


def without(*names: str) -> tuple[str, ...]:
    """Return all parts except those whose names contain one of these words."""
    return tuple(part for part in PART_NAMES if not any(name in part for name in names))


@dataclass(frozen=True)
class Model:
    """The properties of a humanoid model file.

    Attributes:
        parts: body parts that have a bone.
        name: the name of a part's bone.
        vrm: the version of the bone map in the file, if it has one.
        facing_rad: how far the model is turned to its left from facing +z.
        units_per_metre: units of everything below the root.
        root_scale: scale of the root; 1 / units_per_metre converts back to metres.
        up: the axis of the file that points up.
        arms_down_rad: how far the arms are lowered; zero for a T-pose.
        hair: whether the head has a bone without a part, with skin.
        helpers: bones without skin and the part each is attached to, None for the root.
        skin: parts that have skin.
        own_share: weight of a vertex's own bone; the bone before it in the list has the rest.
        binary: GLB, else JSON with the buffer inside.
    """

    parts: Sequence[str] = PART_NAMES
    name: Callable[[str], str] = str
    vrm: Literal[0, 1] | None = None
    facing_rad: float = 0.0
    units_per_metre: float = 1.0
    root_scale: float = 1.0
    up: Literal["y", "z"] = "y"
    arms_down_rad: float = 0.0
    hair: bool = False
    helpers: Mapping[str, str | None] = field(default_factory=dict)
    skin: Sequence[str] = PART_NAMES
    own_share: float = 0.8
    binary: bool = True
    edit: Callable[[dict[str, Any]], None] = field(default=lambda _: None)
    """Changes the JSON before it is written."""


def places() -> dict[str, Array]:
    """Return the joint positions of every part in the T-pose, facing -z, above the floor."""
    usual = {part: np.array(place) for part, place in proportions(STATURE_M).places_m().items()}
    found = dict(usual)
    for part in PART_NAMES:
        side = next((side for side in ("Left", "Right") if part.startswith(side)), "")
        shoulder = f"{side}UpperArm"
        if side and is_arm(part):
            found[part] = usual[shoulder] + _ARMS * (usual[part] - usual[shoulder])
            found[part] = found[part] + np.array((0.0, 0.0, _SHOULDERS_BACK_M))
    return found


def skin_of(part: str) -> Array:
    """Return (N, 3) skin points of a part in its own frame.

    A box along the bone, or a ball around the head.
    """
    bones = proportions(STATURE_M)
    radius = bones.radii_m[part]
    if part == "Head":
        rng = np.random.default_rng(5)
        ball = rng.normal(size=(400, 3))
        ball /= np.linalg.norm(ball, axis=1, keepdims=True)
        return np.array((0.0, 0.1, 0.0)) + 0.1 * ball
    low, high = np.minimum(bones.ends_m[part], 0.0), np.maximum(bones.ends_m[part], 0.0)
    pad = np.full(3, radius)
    if part.endswith(("Foot", "Toes")):
        joint_m = places()[part][1]
        low, high = np.array((0.0, -joint_m, low[2])), np.array((0.0, -joint_m + 0.05, 0.06))
        pad = np.array((0.04, 0.0, 0.0))
        if part.endswith("Toes"):
            high[2] = 0.0
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], dtype=float)
    found: Array = (low - pad) + corners * (high - low + 2.0 * pad)
    return found


def is_arm(part: str) -> bool:
    """Return whether a part moves with the upper arm."""
    return part in FINGER_PARTS or part.endswith(("UpperArm", "LowerArm", "Hand"))
