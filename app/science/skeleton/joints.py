"""Define the 22 body joints and their order, which the whole of Reembody uses.

Names and hierarchy are those of Unity's HumanBodyBones without fingers, eyes and jaw. A parent
always comes before its children, so one pass in order computes forward kinematics. The tests of the
frontend read this file.
"""

_PARENT_OF: dict[str, str | None] = {
    "Hips": None,
    "Spine": "Hips",
    "Chest": "Spine",
    "UpperChest": "Chest",
    "Neck": "UpperChest",
    "Head": "Neck",
    "LeftShoulder": "UpperChest",
    "LeftUpperArm": "LeftShoulder",
    "LeftLowerArm": "LeftUpperArm",
    "LeftHand": "LeftLowerArm",
    "RightShoulder": "UpperChest",
    "RightUpperArm": "RightShoulder",
    "RightLowerArm": "RightUpperArm",
    "RightHand": "RightLowerArm",
    "LeftUpperLeg": "Hips",
    "LeftLowerLeg": "LeftUpperLeg",
    "LeftFoot": "LeftLowerLeg",
    "LeftToes": "LeftFoot",
    "RightUpperLeg": "Hips",
    "RightLowerLeg": "RightUpperLeg",
    "RightFoot": "RightLowerLeg",
    "RightToes": "RightFoot",
}

JOINT_NAMES: tuple[str, ...] = tuple(_PARENT_OF)
JOINT_COUNT = len(JOINT_NAMES)
JOINT_INDEX: dict[str, int] = {name: index for index, name in enumerate(JOINT_NAMES)}

PARENTS: tuple[int, ...] = tuple(
    -1 if parent is None else JOINT_INDEX[parent] for parent in _PARENT_OF.values()
)
"""The index of each joint's parent; -1 for the hips."""
