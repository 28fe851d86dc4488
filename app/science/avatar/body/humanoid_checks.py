"""Check that bones form a human body: complete, connected in order, standing, feet forward."""

from collections.abc import Mapping

import numpy as np

from app.science.avatar.body.body import REQUIRED_PARTS
from app.science.avatar.body.humanoid import HumanoidError, HumanoidPart
from app.science.avatar.body.parts import PARENT_OF, PART_NAMES
from app.science.retargeting import is_below
from app.science.rig import Rig

_BELOW = 0.4
"""Least distance of the feet below the hips, as a share of the distance from hips up to head."""
_BACKWARDS = 0.01
"""Least distance of the toes behind the ankle that counts as pointing backwards, as a share of the
stature."""
_LISTED_BONES = 30


def check_bones(rig: Rig, bones: Mapping[str, int]) -> None:
    """Check that every required part has a bone of its own, below the bone of the part above it.

    Raises HumanoidError with all the parts that are missing or misplaced.
    """
    missing = [part for part in REQUIRED_PARTS if part not in bones]
    if missing:
        raise HumanoidError(
            f"The model has no {', '.join(missing)}, so it is not a humanoid. Map these bones in"
            " the program that made it (as a humanoid, or VRM), or give them these names."
            f" {_bone_list(rig)}"
        )
    wrong = [
        problem for part in PART_NAMES if part in bones for problem in _misplaced(rig, bones, part)
    ]
    if wrong:
        raise HumanoidError(f"The bones do not form a human skeleton: {'; '.join(wrong)}.")


def check_standing(rig: Rig, bones: Mapping[str, int]) -> None:
    """Check that the head is above the hips and the feet are below them, with y up.

    Raises HumanoidError.
    """
    heights = rig.rest_world()[0][:, 1]
    hips = heights[bones["Hips"]]
    head_above_m = heights[bones["Head"]] - hips
    for part in ("LeftFoot", "RightFoot"):
        foot_below_m = hips - heights[bones[part]]
        if not foot_below_m > _BELOW * head_above_m > 0.0:
            raise HumanoidError(
                f"The {part} is not below the hips with the head above them, so this is not a"
                " standing human body. Export the model in its T-pose or A-pose."
            )


def check_feet(parts: Mapping[str, HumanoidPart], stature_m: float) -> None:
    """Check that the feet of a body in the T-pose point forward, along -z.

    Raises HumanoidError if they point backwards, as left and right are then swapped.
    """
    distances_behind_m = []
    for side in ("Left", "Right"):
        foot = parts[f"{side}Foot"]
        if f"{side}Toes" in parts:
            distances_behind_m.append(parts[f"{side}Toes"].place_m[2] - foot.place_m[2])
        elif len(foot.vertices_m):
            low, high = foot.vertices_m[:, 2].min(), foot.vertices_m[:, 2].max()
            distances_behind_m.append(float(low + high))
    if distances_behind_m and float(np.mean(distances_behind_m)) > _BACKWARDS * stature_m:
        raise HumanoidError(
            "The feet point backwards: the bones of left and right are swapped, or the model was"
            " mirrored. Correct the names or the mapping of LeftFoot, RightFoot and their limbs."
        )


def _misplaced(rig: Rig, bones: Mapping[str, int], part: str) -> list[str]:
    name = rig.names[bones[part]]
    sharing = [other for other, bone in bones.items() if bone == bones[part] and other != part]
    if sharing:
        return [f"{name!r} is both {part} and {sharing[0]}"]
    above = PARENT_OF[part]
    while above is not None and above not in bones:
        above = PARENT_OF[above]
    if above is None or is_below(rig, bones[part], bones[above]):
        return []
    return [f"{name!r} is {part}, but is not below {rig.names[bones[above]]!r}, the {above}"]


def _bone_list(rig: Rig) -> str:
    names = ", ".join(rig.names[:_LISTED_BONES])
    more = f" and {rig.joint_count - _LISTED_BONES} more" if rig.joint_count > _LISTED_BONES else ""
    return f"Its bones: {names}{more}."
