"""The 21 joints that have an error, in six parts of the body."""

from app.science.joint_error import ERROR_JOINTS

_LIMB_PARTS = {
    "arm": ("Shoulder", "UpperArm", "LowerArm", "Hand"),
    "leg": ("UpperLeg", "LowerLeg", "Foot", "Toes"),
}
BODY_PARTS: dict[str, tuple[str, ...]] = {
    "head and neck": ("Neck", "Head"),
    "spine": ("Spine", "Chest", "UpperChest"),
    **{
        f"{side.lower()} {limb}": tuple(f"{side}{part}" for part in parts)
        for limb, parts in _LIMB_PARTS.items()
        for side in ("Left", "Right")
    },
}
"""Part -> its joints; each of ERROR_JOINTS is in exactly one."""

PART_OF_JOINT: dict[str, str] = {
    joint: part for part, joints in BODY_PARTS.items() for joint in joints
}
JOINTS_BY_PART: tuple[str, ...] = tuple(
    joint for joints in BODY_PARTS.values() for joint in joints if joint in ERROR_JOINTS
)
