"""Which joint of a capture moves which of ours; a map is data and can be replaced.

Joints a map leaves out are folded in: rotations are carried over in the world, so what LHipJoint or
Neck1 adds is already part of the joint below it. The CMU captures (cgspeed's BVH conversion) name
three spine joints below the neck, which move our three.
"""

from collections.abc import Mapping
from types import MappingProxyType


def _both(pairs: dict[str, str]) -> dict[str, str]:
    sides = ("Left", "Right")
    return {f"{side}{ours}": f"{side}{theirs}" for side in sides for ours, theirs in pairs.items()}


CMU_JOINTS: Mapping[str, str] = MappingProxyType(
    {
        "Hips": "Hips",
        "Spine": "LowerBack",
        "Chest": "Spine",
        "UpperChest": "Spine1",
        "Neck": "Neck",
        "Head": "Head",
        **_both(
            {
                "Shoulder": "Shoulder",
                "UpperArm": "Arm",
                "LowerArm": "ForeArm",
                "Hand": "Hand",
                "UpperLeg": "UpLeg",
                "LowerLeg": "Leg",
                "Foot": "Foot",
                "Toes": "ToeBase",
            }
        ),
    }
)
