"""What the tree of joints tells about a body where names say nothing."""

from collections.abc import Mapping

from app.science.rig import Rig

_ARM = ("Shoulder", "UpperArm", "LowerArm", "Hand")
_LEG = ("UpperLeg", "LowerLeg", "Foot", "Toes")


def is_below(rig: Rig, joint: int, above: int) -> bool:
    """Whether a joint is among another's descendants."""
    while joint > above:
        joint = rig.parents[joint]
    return joint == above and joint >= 0


def path_between(rig: Rig, above: int, below: int) -> list[int]:
    """The joints strictly between two, from above to below; empty where they are no such pair."""
    path: list[int] = []
    joint = rig.parents[below]
    while joint > above:
        path.append(joint)
        joint = rig.parents[joint]
    return path[::-1] if joint == above else []


def hips_above(rig: Rig, found: Mapping[str, int]) -> dict[str, int]:
    """The hips, where no name tells: the joint from which both legs hang."""
    if "Hips" in found or not {"LeftUpperLeg", "RightUpperLeg"} <= set(found):
        return {}
    joint = rig.parents[found["LeftUpperLeg"]]
    while joint >= 0 and not is_below(rig, found["RightUpperLeg"], joint):
        joint = rig.parents[joint]
    return {"Hips": joint} if joint >= 0 and joint not in found.values() else {}


def spine_between(rig: Rig, found: Mapping[str, int]) -> dict[str, int]:
    """Share out the joints between the hips and where arms and neck begin."""
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
    """Add what lies on a limb between or behind joints that are known."""
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
            # A hand has many children; where one is meant there is no choice to make.
            between = between if len(between) == 1 else []
        if between:
            found[joint] = between[0]
            taken.add(between[0])
