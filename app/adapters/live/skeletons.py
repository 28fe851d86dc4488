"""Put the bones of a skeleton in order, and tell what makes a definition unusable.

Bones come in any order and may be damaged: a parent that does not exist, several roots, a circle.
"""

from collections.abc import Collection, Sequence

from app.adapters.live.readings import BoneDefinition, Refused, SkeletonDefinition
from app.science.skeleton import FINGERS, JOINT_NAMES, PARENTS, SEGMENTS

_IN_HEAD = ("LeftEye", "RightEye", "Jaw")


def in_order(bones: Sequence[BoneDefinition]) -> tuple[BoneDefinition, ...]:
    """Return the bones as a depth-first walk from the root, children in the order given.

    That is the order of a BVH file's joints, so a recording has the bones in the same one. Raises
    Refused if there is not exactly one root from which every bone is reached.
    """
    children: dict[str | None, list[BoneDefinition]] = {}
    for bone in bones:
        children.setdefault(bone.parent, []).append(bone)
    roots = children.get(None, [])
    if len(roots) != 1 or len({one.tracker for one in bones}) != len(bones):
        raise Refused("arguments")
    ordered: list[BoneDefinition] = []
    waiting = list(roots)
    while waiting:
        bone = waiting.pop()
        ordered.append(bone)
        waiting += reversed(children.get(bone.tracker, []))
    if len(ordered) != len(bones):  # A circle, or bones below a parent that does not exist.
        raise Refused("arguments")
    return tuple(ordered)


def human_skeleton(bones: Collection[str]) -> SkeletonDefinition | None:
    """Return the skeleton of those of Unity's HumanBodyBones that a source sends, as VMC does.

    A bone's parent is its nearest ancestor that is sent: many bodies have no chest, neck or toes.
    Other bones are left out. None without the hips.
    """
    present = [one for one in HUMAN_PARENTS if one in bones]
    if "Hips" not in present:
        return None
    defined = [BoneDefinition(one, _human_parent(one, present), None) for one in present]
    return SkeletonDefinition("", in_order(defined), in_parent=True)


def _human_parent(bone: str, present: Collection[str]) -> str | None:
    above = HUMAN_PARENTS.get(bone)
    while above is not None and above not in present:
        above = HUMAN_PARENTS[above]
    return above


def _human_parents() -> dict[str, str | None]:
    names: dict[str, str | None] = {
        name: None if parent < 0 else JOINT_NAMES[parent]
        for name, parent in zip(JOINT_NAMES, PARENTS, strict=True)
    }
    names |= dict.fromkeys(_IN_HEAD, "Head")
    for side in ("Left", "Right"):
        for finger in FINGERS:
            above = f"{side}Hand"
            for segment in SEGMENTS:
                names[f"{side}{finger}{segment}"] = above
                above = f"{side}{finger}{segment}"
    return names


HUMAN_PARENTS = _human_parents()
"""Parent by bone of Unity's HumanBodyBones: the body's 22, eyes, jaw and the fingers' 30."""
