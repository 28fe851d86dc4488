"""Map bones to body parts: by VRM's map, or else by names and the hierarchy of bones.

VRM's names are those of HumanBodyBones with a lower-case first letter, except for the thumb of VRM
1.0, whose first bone is the metacarpal: Metacarpal, Proximal, Distal are Unity's Proximal,
Intermediate, Distal. Without VRM the 22 joints of the body are those found by
`app.science.retargeting.joint_map.propose_joint_map`. It is given names without the prefixes of
rigs that are irrelevant to the body (`DEF-` of Rigify, `J_Bip_C_` of VRoid); helper bones (twist,
inverse kinematics, ends) get no name. Fingers are identified by names below the hand
(`app.science.retargeting.finger_names`).
"""

import re
from dataclasses import replace

from app.adapters.humanoids.container import HumanoidFileError
from app.adapters.humanoids.document import Document
from app.science.avatar.body import PART_NAMES
from app.science.retargeting import finger_bones_of, propose_joint_map
from app.science.rig import Rig

_MARK = re.compile(r"^(?:(?:DEF|ORG|MCH|Bn|BN)[-_ ]|J_(?:Bip|Sec|Adj)_(?:C_)?|CC_Base_)")
_TOKEN = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+")
_HELPERS = frozenset(
    ("ik", "fk", "twist", "roll", "pole", "target", "ctrl", "control", "helper", "socket", "end",
     "nub", "tip", "share", "corrective", "attach", "weapon", "prop")
)  # fmt: skip
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
    return bones | finger_bones_of(rig, bones)


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
