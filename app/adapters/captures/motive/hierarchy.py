"""Determine the parents of bones: named in the file from version 1.25 on, known by name before.

Motive has its own bone names (Hip, Ab, Chest, LUArm) or, if selected at export, those of FBX (Hips,
Spine, LeftArm). A skeleton's root has the asset's name, `Asset:Asset`.
"""

from collections.abc import Mapping, Sequence

from app.adapters.captures.capture import CaptureError, Limits
from app.adapters.captures.motive.head import Track

ROOT = "Hip"
_FINGERS = ("Thumb", "Index", "Middle", "Ring", "Pinky")


def _motive_side(s: str) -> dict[str, str]:
    fingers = {
        f"{s}{finger}{bone}": f"{s}{finger}{bone - 1}" if bone > 1 else f"{s}Hand"
        for finger in _FINGERS
        for bone in (1, 2, 3)
    }
    arm = {f"{s}Shoulder": "Chest", f"{s}UArm": f"{s}Shoulder", f"{s}FArm": f"{s}UArm"}
    leg = {
        f"{s}Thigh": ROOT,
        f"{s}Shin": f"{s}Thigh",
        f"{s}Foot": f"{s}Shin",
        f"{s}Toe": f"{s}Foot",
    }
    return {**arm, f"{s}Hand": f"{s}FArm", **fingers, **leg}


def _fbx_side(s: str) -> dict[str, str]:
    fingers = {
        f"{s}Hand{finger}{bone}": f"{s}Hand{finger}{bone - 1}" if bone > 1 else f"{s}Hand"
        for finger in _FINGERS
        for bone in (1, 2, 3)
    }
    arm = {f"{s}Shoulder": "Spine1", f"{s}Arm": f"{s}Shoulder", f"{s}ForeArm": f"{s}Arm"}
    leg = {
        f"{s}UpLeg": ROOT,
        f"{s}Leg": f"{s}UpLeg",
        f"{s}Foot": f"{s}Leg",
        f"{s}ToeBase": f"{s}Foot",
    }
    return {**arm, f"{s}Hand": f"{s}ForeArm", **fingers, **leg}


MOTIVE_PARENTS: Mapping[str, str] = {
    "Ab": ROOT,
    "Chest": "Ab",
    "Neck": "Chest",
    "Head": "Neck",
    **_motive_side("L"),
    **_motive_side("R"),
}
FBX_PARENTS: Mapping[str, str] = {
    "Spine": ROOT,
    "Spine1": "Spine",
    "Neck": "Spine1",
    "Head": "Neck",
    **_fbx_side("Left"),
    **_fbx_side("Right"),
}


def asset_of(track: Track) -> str:
    """Return the skeleton of a bone, whose name is `Asset:Bone`."""
    return track.name.partition(":")[0]


def bone_names(bones: Sequence[Track]) -> list[str]:
    """Return the bones' names without their asset; the root, `Asset:Asset`, becomes the hip."""
    names = []
    for bone in bones:
        asset, _, name = bone.name.partition(":")
        names.append(ROOT if name in {asset, "Hips", ""} else name)
    return names


def bone_parents(bones: Sequence[Track], names: Sequence[str]) -> list[int] | None:
    """Return the index of each bone's parent, -1 for the root.

    None if the file does not name the parents and a bone's name is unknown.
    """
    index = {bone.name: joint for joint, bone in enumerate(bones)}
    if all(bone.parent for bone in bones):
        return [index.get(bone.parent, -1) for bone in bones]
    by_name = {name: joint for joint, name in enumerate(names)}
    table = FBX_PARENTS if "LeftArm" in by_name or "Spine" in by_name else MOTIVE_PARENTS
    parents = [-1 if name == ROOT else by_name.get(table.get(name, ""), -2) for name in names]
    return None if -2 in parents else parents


def parents_first(parents: Sequence[int], names: Sequence[str], limits: Limits) -> list[int]:
    """Order bones so that a parent precedes its children, otherwise as in the file.

    Raises:
        CaptureError: several roots or none, a cycle, or bones nested too deeply.
    """
    roots = [joint for joint, parent in enumerate(parents) if parent < 0]
    if len(roots) != 1:
        listed = ", ".join(names[joint] for joint in roots) or "none"
        raise CaptureError(f"a skeleton has one root bone, this one has: {listed}.")
    children: dict[int, list[int]] = {}
    for joint, parent in enumerate(parents):
        children.setdefault(parent, []).append(joint)
    order: list[int] = []
    waiting = [(roots[0], 1)]
    while waiting:
        joint, depth = waiting.pop()
        if depth > limits.depth:
            raise CaptureError(f"bones are nested deeper than {limits.depth}.")
        order.append(joint)
        waiting.extend((child, depth + 1) for child in reversed(children.get(joint, [])))
    if len(order) != len(parents):
        reached = set(order)
        lost = next(names[joint] for joint in range(len(parents)) if joint not in reached)
        raise CaptureError(f"the parents of bone {lost} form a circle.")
    return order
