"""Whether bones that are called a body's can be one: complete, in order, standing, feet forward."""

from collections.abc import Mapping

import numpy as np

from app.science.avatar.body.body import REQUIRED_PARTS
from app.science.avatar.body.humanoid import HumanoidError, HumanoidPart
from app.science.avatar.body.parts import PARENT_OF, PART_NAMES
from app.science.retargeting import is_below
from app.science.rig import Rig

_BELOW = 0.4
"""How far the feet must hang below the hips, of the way from the hips up to the head."""
_BACKWARDS = 0.01
"""Of the stature: toes so far behind the ankle point backwards."""
_TOLD_BONES = 30


def check_bones(rig: Rig, bones: Mapping[str, int]) -> None:
    """Every required part has a bone of its own, and each hangs below the part above it.

    Raises HumanoidError with all the parts that are missing or hang wrongly.
    """
    missing = [part for part in REQUIRED_PARTS if part not in bones]
    if missing:
        raise HumanoidError(
            f"The model has no {', '.join(missing)}, so it is no humanoid. Map these bones in the"
            " program that made it (as a humanoid, or VRM), or give them these names."
            f" {_bones_seen(rig)}"
        )
    wrong = [told for part in PART_NAMES if part in bones for told in _misplaced(rig, bones, part)]
    if wrong:
        raise HumanoidError(f"The bones hang as no human body's do: {'; '.join(wrong)}.")


def check_standing(rig: Rig, bones: Mapping[str, int]) -> None:
    """The head is over the hips and the feet are under them, y up.

    Raises HumanoidError.
    """
    heights = rig.rest_world()[0][:, 1]
    hips = heights[bones["Hips"]]
    over = heights[bones["Head"]] - hips
    for part in ("LeftFoot", "RightFoot"):
        under = hips - heights[bones[part]]
        if not under > _BELOW * over > 0.0:
            raise HumanoidError(
                f"The {part} does not hang below the hips while the head is above them, so this is"
                " no standing human body. Export the model in its T-pose or A-pose."
            )


def check_feet(parts: Mapping[str, HumanoidPart], stature_m: float) -> None:
    """Feet point forward, or left and right are exchanged; in the T-pose, facing -z.

    Raises HumanoidError.
    """
    behind = []
    for side in ("Left", "Right"):
        foot = parts[f"{side}Foot"]
        if f"{side}Toes" in parts:
            behind.append(parts[f"{side}Toes"].place_m[2] - foot.place_m[2])
        elif len(foot.vertices_m):
            low, high = foot.vertices_m[:, 2].min(), foot.vertices_m[:, 2].max()
            behind.append(float(low + high))
    if behind and float(np.mean(behind)) > _BACKWARDS * stature_m:
        raise HumanoidError(
            "The feet point backwards: the bones of left and right are exchanged, or the model was"
            " mirrored. Correct the names or the map of LeftFoot and RightFoot and of their limbs."
        )


def _misplaced(rig: Rig, bones: Mapping[str, int], part: str) -> list[str]:
    name = rig.names[bones[part]]
    same = [other for other, bone in bones.items() if bone == bones[part] and other != part]
    if same:
        return [f"{name!r} is both {part} and {same[0]}"]
    above = PARENT_OF[part]
    while above is not None and above not in bones:
        above = PARENT_OF[above]
    if above is None or is_below(rig, bones[part], bones[above]):
        return []
    return [f"{name!r} is {part}, but is not below {rig.names[bones[above]]!r}, which is {above}"]


def _bones_seen(rig: Rig) -> str:
    names = ", ".join(rig.names[:_TOLD_BONES])
    more = f" and {rig.joint_count - _TOLD_BONES} more" if rig.joint_count > _TOLD_BONES else ""
    return f"Its bones: {names}{more}."
