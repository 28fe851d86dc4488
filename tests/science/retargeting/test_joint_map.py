"""Tests of joint maps: proposed from names and hierarchy, validated when edited by hand."""

import numpy as np
import pytest

from app.science.retargeting.joint_map import JointMapError, check_joint_map, propose_joint_map
from app.science.rig import Rig
from app.science.rotations import identity
from app.science.skeleton import JOINT_NAMES, PARENTS

BODY = {
    name: JOINT_NAMES[p] if p >= 0 else "" for name, p in zip(JOINT_NAMES, PARENTS, strict=True)
}


def rig_of(tree: str) -> Rig:
    """Return a rig from lines "joint parent", with arbitrary bone lengths."""
    pairs = [line.split() for line in tree.strip().splitlines()]
    names = [pair[0] for pair in pairs]
    parents = [names.index(pair[1]) if len(pair) > 1 else -1 for pair in pairs]
    offsets = np.tile((0.0, 0.1, 0.0), (len(names), 1))
    return Rig(tuple(names), tuple(parents), offsets, identity(len(names)))


def both_sides(limbs: str, left: str, right: str) -> str:
    """Return the lines for both sides, with `*` in the names replaced."""
    return "\n".join(limbs.strip().replace("*", side) for side in (left, right))


CMU = rig_of(
    "Hips\nLowerBack Hips\nSpine LowerBack\nSpine1 Spine\nNeck Spine1\nNeck1 Neck\nHead Neck1\n"
    + both_sides(
        """
*Hip Hips
*UpLeg *Hip
*Leg *UpLeg
*Foot *Leg
*ToeBase *Foot
*Shoulder Spine1
*Arm *Shoulder
*ForeArm *Arm
*Hand *ForeArm
*FingerBase *Hand
""",
        "Left",
        "Right",
    )
)
ASF = rig_of(
    "root\nlowerback root\nupperback lowerback\nthorax upperback\nlowerneck thorax\n"
    "upperneck lowerneck\nhead upperneck\n"
    + both_sides(
        """
*hipjoint root
*femur *hipjoint
*tibia *femur
*foot *tibia
*toes *foot
*clavicle thorax
*humerus *clavicle
*radius *humerus
*wrist *radius
*hand *wrist
*thumb *wrist
""",
        "l",
        "r",
    )
)
MOTIVE = rig_of(
    "Hip\nAb Hip\nChest Ab\nNeck Chest\nHead Neck\n"
    + both_sides(
        """
*Shoulder Chest
*UArm *Shoulder
*FArm *UArm
*Hand *FArm
*Thigh Hip
*Shin *Thigh
*Foot *Shin
*Toe *Foot
""",
        "L",
        "R",
    )
)
MANNEQUIN = rig_of(
    "pelvis\nspine_01 pelvis\nspine_02 spine_01\nspine_03 spine_02\n"
    "neck_01 spine_03\nhead neck_01\n"
    + both_sides(
        """
clavicle_* spine_03
upperarm_* clavicle_*
lowerarm_* upperarm_*
hand_* lowerarm_*
thigh_* pelvis
calf_* thigh_*
foot_* calf_*
ball_* foot_*
""",
        "l",
        "r",
    )
)


@pytest.mark.parametrize(
    ("rig", "unmapped"),
    [
        (CMU, ()),
        (ASF, ()),
        (MOTIVE, ("UpperChest",)),
        (MANNEQUIN, ()),
        (rig_of("\n".join(f"{a} {b}" for a, b in BODY.items())), ()),
        (rig_of("\n".join(f"mixamorig:{a} {b and 'mixamorig:' + b}" for a, b in BODY.items())), ()),
    ],
    ids=["cmu-bvh", "asf", "motive", "mannequin", "body", "namespace"],
)
def test_the_usual_skeletons_are_mapped_completely(rig: Rig, unmapped: tuple[str, ...]) -> None:
    """Every joint of the usual skeletons that has a part is mapped, each once, parents first."""
    proposal = propose_joint_map(rig)
    assert proposal.unmapped_body_joints == unmapped
    check_joint_map(rig, proposal.joint_map)


def test_known_answers_of_each_naming() -> None:
    """Misleading joint names of each system are mapped to the right parts."""
    assert propose_joint_map(ASF).joint_map["Hips"] == "root"
    assert propose_joint_map(ASF).joint_map["LeftHand"] == "lhand"
    assert propose_joint_map(ASF).joint_map["UpperChest"] == "thorax"
    assert propose_joint_map(CMU).joint_map["LeftUpperLeg"] == "LeftUpLeg"
    assert propose_joint_map(CMU).joint_map["Spine"] == "LowerBack"
    assert propose_joint_map(MOTIVE).joint_map["RightLowerArm"] == "RFArm"
    assert propose_joint_map(MANNEQUIN).joint_map["LeftShoulder"] == "clavicle_l"
    assert propose_joint_map(MANNEQUIN).unmapped_rig_joints == ()


def test_a_shoulder_is_the_upper_arm_where_there_is_no_other() -> None:
    """If joints are named shoulder, elbow and wrist, the shoulder is mapped to the upper arm."""
    rig = rig_of(
        "pelvis\ntorso pelvis\nneck torso\nhead neck\n"
        + both_sides(
            "*_shoulder torso\n*_elbow *_shoulder\n*_wrist *_elbow\n*_hip pelvis\n"
            "*_knee *_hip\n*_ankle *_knee",
            "left",
            "right",
        )
    )
    joint_map = propose_joint_map(rig).joint_map
    assert joint_map["LeftUpperArm"] == "left_shoulder"
    assert joint_map["RightHand"] == "right_wrist"
    assert joint_map["LeftUpperLeg"] == "left_hip"
    assert "LeftShoulder" not in joint_map


def test_unnamed_joints_of_a_limb_are_found_by_hierarchy() -> None:
    """A joint between a thigh and a foot is mapped to the shin, whatever its name."""
    rig = rig_of(
        "base\nbelly base\n"
        + both_sides("*Thigh base\n*X *Thigh\n*Foot *X\n*End *Foot", "Left", "Right")
    )
    proposal = propose_joint_map(rig)
    assert proposal.joint_map["Hips"] == "base"
    assert proposal.joint_map["LeftLowerLeg"] == "LeftX"
    assert proposal.joint_map["RightToes"] == "RightEnd"
    assert proposal.sources["LeftLowerLeg"] == "hierarchy"
    assert proposal.sources["LeftFoot"] == "name"


def test_a_map_made_by_hand_is_rejected_with_every_problem() -> None:
    """All problems of an invalid joint map are reported together.

    An unknown joint, a duplicate, a child above its parent, and missing hips.
    """
    with pytest.raises(JointMapError) as refused:
        check_joint_map(
            CMU,
            {
                "Head": "Kopf",
                "LeftUpperLeg": "LeftFoot",
                "LeftFoot": "LeftUpLeg",
                "LeftHand": "LeftArm",
                "LeftLowerArm": "LeftArm",
                "Tail": "Spine",
            },
        )
    wrong = [joint for joint, _ in refused.value.problems]
    assert set(wrong) == {"Head", "LeftFoot", "LeftHand", "LeftLowerArm", "Tail", "Hips"}
    assert "it has Hips" in str(refused.value)
