"""Map bones to body parts: by VRM's map, or else by names and the hierarchy of bones.

VRM's names are those of HumanBodyBones with a lower-case first letter, except for the thumb of VRM
1.0, whose first bone is the metacarpal: Metacarpal, Proximal, Distal are Unity's Proximal,
Intermediate, Distal. Without VRM the 22 joints of the body are those found by
`app.science.retargeting.joint_map.propose_joint_map`. It is given names without the prefixes of
rigs that are irrelevant to the body (`DEF-` of Rigify, `J_Bip_C_` of VRoid); helper bones (twist,
inverse kinematics, ends) get no name. Fingers are identified by names below the hand: Mixamo's
`LeftHandIndex1`, Unreal's `index_01_l`, Rigify's `f_index.01.L`, `Bip01 L Finger11` of 3ds Max,
`finger2-1.L` of MakeHuman. Metacarpals are part of the hand; of the other bones the first three of
a chain count, so a fourth, the tip in some rigs, does not.
"""

import re
from collections.abc import Mapping
from dataclasses import replace

from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.document import Document
from app.science.avatar.body import FINGERS, PART_NAMES, SEGMENTS, SIDES
from app.science.retargeting import is_below, propose_joint_map
from app.science.rig import Rig

_WORDS = {
    "thumb": "Thumb", "index": "Index", "forefinger": "Index", "middle": "Middle", "ring": "Ring",
    "little": "Little", "pinky": "Little", "pinkie": "Little",
}  # fmt: skip
_MARK = re.compile(r"^(?:(?:DEF|ORG|MCH|Bn|BN)[-_ ]|J_(?:Bip|Sec|Adj)_(?:C_)?|CC_Base_)")
_TOKEN = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+")
_HELPERS = frozenset(
    ("ik", "fk", "twist", "roll", "pole", "target", "ctrl", "control", "helper", "socket", "end",
     "nub", "tip", "share", "corrective", "attach", "weapon", "prop")
)  # fmt: skip
_WORD = re.compile("|".join(_WORDS))
_BIPED = re.compile(r"finger\s*([0-4])([12]?)$")
_NUMBERED = re.compile(r"finger\s*([1-5])[-_.]([1-3])")
_NO_SEGMENT = re.compile(r"metacarpal|palm|carpal")
_VRM1_THUMB = {"Metacarpal": "Proximal", "Proximal": "Intermediate", "Distal": "Distal"}


def vrm_nodes(document: Document) -> dict[str, int] | None:
    """Return body part -> node by VRM's map; None if the file has no map.

    Raises HumanoidFileError if the map names a node that does not exist, or a part twice.
    """
    extensions = document.extensions
    found: list[tuple[str, int]]
    if extensions is not None and extensions.vrm1 is not None:
        bones = extensions.vrm1.humanoid.humanBones
        found = [(_vrm1_part(name), bone.node) for name, bone in bones.items()]
        place = "extensions.VRMC_vrm.humanoid.humanBones"
    elif extensions is not None and extensions.vrm0 is not None and extensions.vrm0.humanoid:
        rows = extensions.vrm0.humanoid.humanBones
        found = [(_part(row.bone), row.node) for row in rows if row.node >= 0]
        place = "extensions.VRM.humanoid.humanBones"
    else:
        return None
    nodes: dict[str, int] = {}
    for part, node in found:
        if node >= len(document.nodes):
            raise HumanoidFileError(f"{part} is node {node}, which is not there.", place)
        if part in PART_NAMES and nodes.setdefault(part, node) != node:
            raise HumanoidFileError(f"{part} is node {nodes[part]} and node {node}.", place)
    return nodes


def named_bones(rig: Rig) -> dict[str, int]:
    """Return body part -> bone, as far as names and hierarchy identify them."""
    plain = replace(rig, names=tuple(_plain(name, row) for row, name in enumerate(rig.names)))
    proposed = propose_joint_map(plain).joint_map
    bones = {part: plain.index(name) for part, name in proposed.items()}
    for side in SIDES:
        if f"{side}Hand" in bones:
            bones |= _fingers(rig, side, bones)
    return bones


def _plain(name: str, row: int) -> str:
    """Return a bone's name without prefixes, made unique by its number.

    A helper bone gets only its number, so that it matches no body part.
    """
    bare = _MARK.sub("", name.rsplit(":", 1)[-1])
    words = {token.lower() for token in _TOKEN.findall(bare)}
    return f"({row})" if words & _HELPERS else f"{bare} ({row})"


def _part(name: str) -> str:
    return name[:1].upper() + name[1:]


def _vrm1_part(name: str) -> str:
    part = _part(name)
    side, thumb, segment = part.partition("Thumb")
    return f"{side}{thumb}{_VRM1_THUMB.get(segment, segment)}" if thumb else part


def _fingers(rig: Rig, side: str, bones: Mapping[str, int]) -> dict[str, int]:
    hand, taken = bones[f"{side}Hand"], set(bones.values())
    chains: dict[str, list[int]] = {finger: [] for finger in FINGERS}
    for bone in range(hand + 1, rig.joint_count):
        if bone in taken or not is_below(rig, bone, hand):
            continue
        finger = _finger(rig.names[bone], rig.names[hand])
        if finger is None:
            continue
        chain = chains[finger]
        if len(chain) < len(SEGMENTS) and (not chain or is_below(rig, bone, chain[-1])):
            chain.append(bone)
    return {
        f"{side}{finger}{segment}": bone
        for finger, chain in chains.items()
        for segment, bone in zip(SEGMENTS, chain, strict=False)
    }


def _finger(name: str, hand: str) -> str | None:
    """Return the finger to which a bone below the hand belongs; None if it belongs to none."""
    word = name.rsplit(":", 1)[-1].lower()
    # `LeftHandRing1` below `LeftHand`: ignore the common beginning.
    word = word.removeprefix(hand.rsplit(":", 1)[-1].lower())
    named = _WORD.search(word)
    if named is not None:
        # The thumb's metacarpal is its first segment; those of the other fingers are part of the
        # hand.
        inner = _NO_SEGMENT.search(word) is not None and named.group() != "thumb"
        return None if inner else _WORDS[named.group()]
    numbered = _NUMBERED.search(word)
    if numbered is not None:
        return FINGERS[int(numbered.group(1)) - 1]
    biped = _BIPED.search(word)
    return FINGERS[int(biped.group(1))] if biped is not None else None
