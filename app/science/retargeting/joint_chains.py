"""Identify joints of a body from the hierarchy of a rig where their names do not."""

from collections.abc import Mapping

from app.science.rig import Rig

_ARM = ("Shoulder", "UpperArm", "LowerArm", "Hand")
_LEG = ("UpperLeg", "LowerLeg", "Foot", "Toes")


def is_below(rig: Rig, joint: int, above: int) -> bool:
    """Return whether a joint is a descendant of `above` or the same joint."""
    while joint > above:
        joint = rig.parents[joint]
    return joint == above and joint >= 0


def path_between(rig: Rig, above: int, below: int) -> list[int]:
    """Return the joints strictly between two, from above to below.

    Empty if `above` is not an ancestor of `below`.
    """
    path: list[int] = []
    joint = rig.parents[below]
    while joint > above:
        path.append(joint)
        joint = rig.parents[joint]
    return path[::-1] if joint == above else []


def hips_above(rig: Rig, found: Mapping[str, int]) -> dict[str, int]:
    """Identify the hips, unless named, as the nearest common ancestor of both legs."""
    if "Hips" in found or not {"LeftUpperLeg", "RightUpperLeg"} <= set(found):
        return {}
    joint = rig.parents[found["LeftUpperLeg"]]
    while joint >= 0 and not is_below(rig, found["RightUpperLeg"], joint):
        joint = rig.parents[joint]
    return {"Hips": joint} if joint >= 0 and joint not in found.values() else {}


def spine_between(rig: Rig, found: Mapping[str, int]) -> dict[str, int]:
    """Assign the joints between hips and neck (or shoulder) to the parts of the spine."""
    if "Hips" not in found:
        return {}
    ends = [
        found[name] for name in ("Neck", "LeftShoulder", "LeftUpperArm", "Head") if name in found
    ]
    taken = set(found.values())
    chains = [[j for j in path_between(rig, found["Hips"], end) if j not in taken] for end in ends]
    chain = next((chain for chain in chains if chain), [])
    if not chain:
        return {}
    if len(chain) <= 3:
        return dict(zip(("Spine", "Chest", "UpperChest"), chain, strict=False))
    return {"Spine": chain[0], "Chest": chain[1], "UpperChest": chain[-1]}


def complete_limbs(rig: Rig, found: Mapping[str, int]) -> dict[str, int]:
    """Add the missing joints of limbs that lie between or below joints that are already found."""
    complete = dict(found)
    for side in ("Left", "Right"):
        for limb in (_ARM, _LEG):
            _complete(rig, [f"{side}{part}" for part in limb], complete)
    return complete


def _complete(rig: Rig, limb: list[str], found: dict[str, int]) -> None:
    taken = set(found.values())
    for above, joint, below in zip(limb[:-1], limb[1:], [*limb[2:], ""], strict=True):
        if joint in found or above not in found:
            continue
        if below in found:
            between = [j for j in path_between(rig, found[above], found[below]) if j not in taken]
        else:
            between = [j for j in rig.children(found[above]) if j not in taken]
            # A joint with several children, such as a hand, is ambiguous.
            between = between if len(between) == 1 else []
        if between:
            found[joint] = between[0]
            taken.add(between[0])
