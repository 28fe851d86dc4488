"""Joint names of many systems, taken apart into a side and a word for the part of the body.

Names come as `LeftUpLeg` (CMU's BVH conversion), `lfemur` (ASF), `upperarm_l` (Unreal), `LUArm`
(Motive), `mixamorig:LeftForeArm`, `Skeleton 002_LShin` (NatNet), `left_upper_arm`
or `Bip01 L Calf`.
"""

import re
from types import MappingProxyType

_TOKEN = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+|\d+")
_SIDES = {"left": "Left", "l": "Left", "right": "Right", "r": "Right"}

# In each row the surest word first: a rig may have a wrist and a hand, a hip joint and a thigh.
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

    A prefix up to a colon is a namespace and one up to an underscore may be an asset's name; it is
    left out where what remains says more.
    """
    bare = name.rsplit(":", 1)[-1]
    side, word = _taken_apart(bare)
    if "_" in bare and word not in _SIDED:
        inner = _taken_apart(bare.split("_", 1)[1])
        if inner[1] in _SIDED or any(inner[1] in words for words in CENTRE_WORDS.values()):
            return (inner[0] or side, inner[1])
    return side, word


def _taken_apart(name: str) -> tuple[str, str]:
    tokens = [token.lower() for token in _TOKEN.findall(name)]
    sides = [_SIDES[token] for token in tokens if token in _SIDES]
    rest = [token for token in tokens if token not in _SIDES and not token.isdigit()]
    word = "".join(token for token in rest if not re.fullmatch(r"bip|bone|jnt|joint", token))
    if not sides and word[:1] in {"l", "r"} and word[1:] in _SIDED:
        return _SIDES[word[0]], word[1:]
    return (sides[0] if sides else ""), word
