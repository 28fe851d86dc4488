"""Identify the bones of fingers below the hands of a rig by their names.

Names are Mixamo's `LeftHandIndex1`, Unreal's `index_01_l`, Rigify's `f_index.01.L`, `Bip01 L
Finger11` of 3ds Max, `finger2-1.L` of MakeHuman. Metacarpals are part of the hand; of the other
bones the first three of a chain count, so a fourth, the tip in some rigs, does not.
"""

import re
from collections.abc import Mapping

from app.science.retargeting.joint_chains import is_below
from app.science.rig import Rig
from app.science.skeleton import FINGERS, SEGMENTS

_WORDS = {
    "thumb": "Thumb", "index": "Index", "forefinger": "Index", "middle": "Middle", "ring": "Ring",
    "little": "Little", "pinky": "Little", "pinkie": "Little",
}  # fmt: skip
_WORD = re.compile("|".join(_WORDS))
_BIPED = re.compile(r"finger\s*([0-4])([12]?)$")
_NUMBERED = re.compile(r"finger\s*([1-5])[-_.]([1-3])")
_NO_SEGMENT = re.compile(r"metacarpal|palm|carpal")


def finger_bones_of(rig: Rig, bones: Mapping[str, int]) -> dict[str, int]:
    """Return finger part -> bone, for the hands among `bones` (body part -> bone)."""
    found: dict[str, int] = {}
    for side in ("Left", "Right"):
        if f"{side}Hand" in bones:
            found |= _of_hand(rig, side, bones[f"{side}Hand"], set(bones.values()))
    return found


def _of_hand(rig: Rig, side: str, hand: int, taken: set[int]) -> dict[str, int]:
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
