"""Joint maps: which joint of a rig corresponds to which joint of the human body.

A map assigns joints of a rig to joints of the human body (HumanBodyBones,
`app.science.skeleton.JOINT_NAMES`). Source and avatar each have one, so any two skeletons are
related through the body's joints, and a map made once can be reused wherever its skeleton is used.

A map is proposed from the names of joints, which are split into a side and a word for the part of
the body. Examples are `LeftUpLeg` (CMU's BVH conversion), `lfemur` (ASF), `upperarm_l` (Unreal),
`LUArm` (Motive), `mixamorig:LeftForeArm`, `Skeleton 002_LShin` (NatNet), `left_upper_arm` or `Bip01
L Calf`.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Literal

from app.science.retargeting.joint_chains import (
    complete_limbs,
    hips_above,
    is_below,
    spine_between,
)
from app.science.rig import Rig, RigError
from app.science.skeleton import JOINT_NAMES, PARENTS

JointMap = Mapping[str, str]
"""Body joint -> joint of the rig; absent body joints are unmapped."""
Found = Literal["name", "hierarchy"]


class JointMapError(RigError):
    """A joint map does not match its skeleton: a joint is unknown, mapped twice or misplaced.

    Attributes:
        problems: (body joint, what is wrong there and what is valid), one for each problem.
    """

    def __init__(self, problems: tuple[tuple[str, str], ...]) -> None:
        self.problems = problems
        super().__init__("; ".join(f"{joint}: {problem}" for joint, problem in problems))


@dataclass(frozen=True)
class Proposal:
    """A joint map derived from names and hierarchy, and the joints that remain unmapped.

    Attributes:
        joint_map: body joint -> rig joint.
        sources: body joint -> whether it was identified by its name or by its place in the
            hierarchy.
        unmapped_body_joints: those of the 22 body joints that are not mapped; in an avatar they
            keep their T-pose.
        unmapped_rig_joints: joints of the rig that are not mapped; they move nothing, and in an
            avatar they keep their rest pose.
    """

    joint_map: JointMap
    sources: Mapping[str, Found]
    unmapped_body_joints: tuple[str, ...]
    unmapped_rig_joints: tuple[str, ...]


def propose_joint_map(rig: Rig) -> Proposal:
    """Derive a map from the joints' names or, where names are unknown, from their hierarchy.

    The joints between hips and neck are assigned to the spine by their number: a single one is the
    Spine; two are Spine and Chest; of more, the first is the Spine, the second the Chest, the last
    the UpperChest.
    """
    by_name = _by_name(rig)
    found = {joint: place for joint, place in by_name.items() if _in_order(rig, by_name, joint)}
    found |= hips_above(rig, found)
    found |= spine_between(rig, found)
    complete = complete_limbs(rig, found)
    named = {joint: rig.names[place] for joint, place in complete.items()}
    joint_map = {joint: named[joint] for joint in JOINT_NAMES if joint in named}
    sources: dict[str, Found] = {
        joint: "name" if by_name.get(joint) == complete[joint] else "hierarchy"
        for joint in joint_map
    }
    return Proposal(
        MappingProxyType(joint_map),
        MappingProxyType(sources),
        unmapped_body_joints(joint_map),
        unmapped_rig_joints(rig, joint_map),
    )


def unmapped_body_joints(joint_map: JointMap) -> tuple[str, ...]:
    """Return the body joints that a map leaves out, in the skeleton's order."""
    return tuple(joint for joint in JOINT_NAMES if joint not in joint_map)


def unmapped_rig_joints(rig: Rig, joint_map: JointMap) -> tuple[str, ...]:
    """Return the rig's joints that a map leaves out, in the rig's order."""
    used = set(joint_map.values())
    return tuple(name for name in rig.names if name not in used)


def check_joint_map(rig: Rig, joint_map: JointMap) -> None:
    """Raise JointMapError with every problem of a map, which may have been edited by hand."""
    problems = [problem for joint in joint_map for problem in _problems(rig, joint_map, joint)]
    if "Hips" not in joint_map:
        problems.append(("Hips", "is not mapped: without the hips the body has no position"))
    if problems:
        raise JointMapError(tuple(problems))


def _problems(rig: Rig, joint_map: JointMap, joint: str) -> list[tuple[str, str]]:
    name = joint_map[joint]
    if joint not in JOINT_NAMES:
        return [(joint, f"is not a joint of the body: valid are {', '.join(JOINT_NAMES)}")]
    if name not in rig.names:
        return [(joint, f"the skeleton has no joint {name!r}: it has {', '.join(rig.names)}")]
    problems = []
    others = [other for other in joint_map if other != joint and joint_map[other] == name]
    if others:
        problems.append((joint, f"{name!r} is also mapped to {others[0]}: map each joint once"))
    above = _mapped_above(joint, joint_map)
    if above is None or joint_map[above] not in rig.names or joint_map[above] == name:
        return problems
    if not is_below(rig, rig.index(name), rig.index(joint_map[above])):
        reason = f"{name!r} is not below {joint_map[above]!r}, which is {above}"
        problems.append((joint, f"{reason}: choose a joint further out"))
    return problems


def _mapped_above(joint: str, joint_map: Mapping[str, object]) -> str | None:
    """Return the nearest mapped ancestor of a body joint, as a body joint."""
    above = PARENTS[JOINT_NAMES.index(joint)]
    while above >= 0:
        if JOINT_NAMES[above] in joint_map:
            return JOINT_NAMES[above]
        above = PARENTS[above]
    return None


def _in_order(rig: Rig, found: Mapping[str, int], joint: str) -> bool:
    above = _mapped_above(joint, found)
    return above is None or is_below(rig, found[joint], found[above])


def _by_name(rig: Rig) -> dict[str, int]:
    """Return the rig joint with the most specific name for each body joint.

    Of equally specific ones the joint nearest to the root is chosen.
    """
    side_words = [side_and_word(name) for name in rig.names]
    found: dict[str, int] = {}
    taken: set[int] = set()
    for part, words in CENTRE_WORDS.items():
        _assign_first(found, taken, part, [("", word) for word in words], side_words)
    for side in ("Left", "Right"):
        for part in ("UpperArm", "Shoulder", *(p for p in SIDE_WORDS if "Shoulder" not in p)):
            if f"{side}{part}" in found:
                continue
            candidates = [(side, word) for word in SIDE_WORDS[part]]
            if part == "UpperArm" and any(key in side_words for key in candidates[:-2]):
                # There is a more specific word for the upper arm, so "shoulder" denotes the collar
                # bone.
                candidates = candidates[:-2]
            _assign_first(found, taken, f"{side}{part}", candidates, side_words)
    return found


def _assign_first(
    found: dict[str, int],
    taken: set[int],
    joint: str,
    candidates: list[tuple[str, str]],
    side_words: list[tuple[str, str]],
) -> None:
    for key in candidates:
        places = [
            place
            for place, side_word in enumerate(side_words)
            if side_word == key and place not in taken
        ]
        if places:
            found[joint] = places[0]
            taken.add(places[0])
            return


_TOKEN = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|\d+")
_SIDES = {"left": "Left", "l": "Left", "right": "Right", "r": "Right"}

# Most specific word first: a rig may have a wrist and a hand, or a hip joint and a thigh.
CENTRE_WORDS = MappingProxyType(
    {
        "Hips": ("hips", "pelvis", "hip", "root", "bodybase"),
        "Neck": ("neck", "lowerneck", "neckbase"),
        "Head": ("head", "skull"),
    }
)
SIDE_WORDS = MappingProxyType(
    {
        "Shoulder": ("clavicle", "collar", "collarbone", "shoulder", "shldr"),
        "UpperArm": ("upperarm", "uparm", "uarm", "arm", "humerus", "shoulder", "shldr"),
        "LowerArm": ("lowerarm", "forearm", "lowarm", "farm", "radius", "elbow"),
        "Hand": ("hand", "palm", "wrist"),
        "UpperLeg": ("upperleg", "upleg", "thigh", "femur", "uleg", "hip"),
        "LowerLeg": ("lowerleg", "lowleg", "shin", "calf", "tibia", "leg", "shank", "knee", "lleg"),
        "Foot": ("foot", "ankle"),
        "Toes": ("toes", "toebase", "toe", "ball", "forefoot"),
    }
)
_SIDED = frozenset(word for words in SIDE_WORDS.values() for word in words)


def side_and_word(name: str) -> tuple[str, str]:
    """Return "Left", "Right" or "" and the rest of a name, in lower case and without numbers.

    A prefix up to a colon is a namespace and is dropped. A prefix up to an underscore may be an
    asset's name; it is dropped if the remaining name is a known word and the whole name is not.
    """
    bare = name.rsplit(":", 1)[-1]
    side, word = _split_name(bare)
    if "_" in bare and word not in _SIDED:
        inner = _split_name(bare.split("_", 1)[1])
        if inner[1] in _SIDED or any(inner[1] in words for words in CENTRE_WORDS.values()):
            return (inner[0] or side, inner[1])
    return side, word


def _split_name(name: str) -> tuple[str, str]:
    tokens = [token.lower() for token in _TOKEN.findall(name)]
    sides = [_SIDES[token] for token in tokens if token in _SIDES]
    rest = [token for token in tokens if token not in _SIDES and not token.isdigit()]
    word = "".join(token for token in rest if not re.fullmatch(r"bip|bone|jnt|joint", token))
    if not sides and word[:1] in {"l", "r"} and word[1:] in _SIDED:
        return _SIDES[word[0]], word[1:]
    return (sides[0] if sides else ""), word
