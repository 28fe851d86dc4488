"""Tests that humanoid models are read correctly, whatever the layout of their files."""

import math
from functools import partial

import numpy as np
import pytest

from app.adapters.humanoids import ReadHumanoid, read_humanoid
from app.science.avatar.body import FINGER_PARTS, FINGERS, PART_NAMES, SEGMENTS, figure_of
from app.science.skeleton import JOINT_NAMES
from tests.support.humanoid_files import humanoid_file
from tests.support.humanoid_model import (
    STATURE_M,
    Model,
    mixamo_name,
    places,
    skin_of,
    without,
)


def numbered(part: str) -> str:
    """Return a name that does not identify the part."""
    return f"bone{PART_NAMES.index(part):03d}"


RIGS = {
    "Unreal": (
        "pelvis spine_01 spine_02 spine_03 neck_01 head"
        " clavicle_l upperarm_l lowerarm_l hand_l thigh_l calf_l foot_l ball_l"
    ),
    "Rigify": (
        "DEF-spine DEF-spine.001 DEF-spine.002 DEF-spine.003 DEF-neck DEF-head DEF-shoulder.L"
        " DEF-upper_arm.L DEF-forearm.L DEF-hand.L DEF-thigh.L DEF-shin.L DEF-foot.L DEF-toe.L"
    ),
    "VRoid": (
        "J_Bip_C_Hips J_Bip_C_Spine J_Bip_C_Chest J_Bip_C_UpperChest J_Bip_C_Neck J_Bip_C_Head"
        " J_Bip_L_Shoulder J_Bip_L_UpperArm J_Bip_L_LowerArm J_Bip_L_Hand"
        " J_Bip_L_UpperLeg J_Bip_L_LowerLeg J_Bip_L_Foot J_Bip_L_ToeBase"
    ),
    "3ds Max": (
        "Bip01,Bip01 Spine,Bip01 Spine1,Bip01 Spine2,Bip01 Neck,Bip01 Head,Bip01 L Clavicle,"
        "Bip01 L UpperArm,Bip01 L Forearm,Bip01 L Hand,Bip01 L Thigh,Bip01 L Calf,Bip01 L Foot,"
        "Bip01 L Toe0"
    ),
    "MakeHuman": (
        "root spine05 spine04 spine03 neck01 head clavicle.L upperarm01.L lowerarm01.L wrist.L"
        " upperleg01.L lowerleg01.L foot.L toe1-1.L"
    ),
}
"""Names of the 14 joints of trunk and left side in the rigs of several programs."""
_OTHER_SIDE = (("_l", "_r"), (".L", ".R"), ("_L_", "_R_"), (" L ", " R "))
HELPERS = {
    "ik_foot_root": None, "ik_foot_l": None, "ik_hand_root": None, "ik_hand_l": None,
    "upperarm_twist_01_l": "LeftUpperArm", "LeftForeArmTwist": "LeftLowerArm",
    "HeadTop_End": "Head", "hand_r_weapon": "RightHand", "thigh_twist_01_r": "RightUpperLeg",
}  # fmt: skip


def named_as(rig: str, part: str) -> str:
    """Return the part's name in a program's rig; fingers keep their names."""
    if part in FINGER_PARTS:
        return part
    words = RIGS[rig].split("," if "," in RIGS[rig] else " ")
    left = [name for name in JOINT_NAMES if not name.startswith("Right")]
    word = words[left.index(part.replace("Right", "Left"))]
    if not part.startswith("Right"):
        return word
    mark, other = next(pair for pair in _OTHER_SIDE if pair[0] in word)
    return word.replace(mark, other)


def unreal_name(part: str) -> str:
    """Return Unreal's name of a finger part: `index_01_l` for `LeftIndexProximal`."""
    if part not in FINGER_PARTS:
        return named_as("Unreal", part)
    side = "l" if part.startswith("Left") else "r"
    finger = part.removeprefix("Left").removeprefix("Right")
    for number, segment in enumerate(("Proximal", "Intermediate", "Distal"), start=1):
        finger = finger.replace(segment, f"_{number:02d}")
    return f"{finger.lower().replace('little', 'pinky')}_{side}"


def makehuman_name(part: str) -> str:
    """Return MakeHuman's name of a finger part: `finger2-1.L` for `LeftIndexProximal`."""
    if part not in FINGER_PARTS:
        return named_as("MakeHuman", part)
    finger = next(row for row, name in enumerate(FINGERS, start=1) if name in part)
    segment = next(row for row, name in enumerate(SEGMENTS, start=1) if part.endswith(name))
    return f"finger{finger}-{segment}.{part[0]}"


def biped_name(part: str) -> str:
    """Return Biped's name of a finger part: `Bip01 L Finger11` for `LeftIndexIntermediate`."""
    if part not in FINGER_PARTS:
        return part
    finger = next(row for row, name in enumerate(FINGERS) if name in part)
    segments = {"Proximal": "", "Intermediate": "1", "Distal": "2"}
    segment = next(mark for name, mark in segments.items() if part.endswith(name))
    return f"Bip01 {part[0]} Finger{finger}{segment}"


MODELS = {
    "five fingers": Model(),
    "four fingers": Model(parts=without("Little")),
    "three fingers": Model(parts=without("Little", "Ring")),
    "no fingers": Model(parts=without(*FINGER_PARTS)),
    "no toes, upper chest, neck or shoulders": Model(
        parts=without("Toes", "UpperChest", "Neck", "Shoulder")
    ),
    "VRM 0, facing -z": Model(vrm=0, name=numbered, facing_rad=math.pi),
    "VRM 1": Model(vrm=1, name=numbered),
    "VRM 1 with four fingers": Model(vrm=1, name=numbered, parts=without("Little")),
    "Mixamo, centimetres under a scaled root": Model(
        name=mixamo_name, units_per_metre=100.0, root_scale=0.01
    ),
    **{rig: Model(name=partial(named_as, rig)) for rig in RIGS},
    "Unreal with fingers and bones that help": Model(name=unreal_name, helpers=HELPERS),
    "3ds Max's fingers": Model(name=biped_name),
    "MakeHuman with fingers": Model(name=makehuman_name),
    "centimetres": Model(units_per_metre=100.0),
    "z up": Model(up="z"),
    "turned by 57 degrees": Model(facing_rad=1.0),
    "A-pose": Model(arms_down_rad=0.8),
    "JSON with its buffer inside": Model(binary=False),
}


@pytest.fixture(params=MODELS, scope="module")
def case(request: pytest.FixtureRequest) -> tuple[Model, ReadHumanoid]:
    """Return each model with what was read from its file."""
    model = MODELS[request.param]
    return model, read_humanoid(humanoid_file(model))


def test_every_bone_becomes_its_part(case: tuple[Model, ReadHumanoid]) -> None:
    """All parts with a bone are read and no others; VRM's map is used if there is one."""
    model, read = case
    assert set(read.humanoid.parts) == set(model.parts)
    assert read.bones_by == ("names" if model.vrm is None else "vrm")


def test_joints_lie_where_they_were_put(case: tuple[Model, ReadHumanoid]) -> None:
    """Joints are in the T-pose facing -z, in metres, feet on the floor, hips over the origin."""
    model, read = case
    where, hips = places(), places()["Hips"]
    for part in model.parts:
        expected = where[part] - np.array((hips[0], 0.0, hips[2]))
        assert read.humanoid.parts[part].place_m == pytest.approx(expected.tolist(), abs=1e-6)
    assert read.humanoid.stature_m == pytest.approx(STATURE_M, abs=1e-6)


def test_skin_goes_with_its_bone(case: tuple[Model, ReadHumanoid]) -> None:
    """Each part has exactly the vertices that are bound to it, in its own frame."""
    model, read = case
    for part in model.parts:
        found = read.humanoid.parts[part].vertices_m
        expected = skin_of(part)
        assert found.shape == expected.shape, part
        assert np.abs(found - expected).max() < 1e-6, part


def test_hair_belongs_to_the_head() -> None:
    """Vertices of a bone that is no part go to the next part above, without adding height."""
    plain, hairy = (
        read_humanoid(humanoid_file(Model(hair=hair))).humanoid for hair in (False, True)
    )
    more = len(hairy.parts["Head"].vertices_m) - len(plain.parts["Head"].vertices_m)
    assert more == len(skin_of("Head"))
    assert hairy.stature_m == pytest.approx(plain.stature_m, abs=1e-9)


def test_a_part_without_skin_has_no_piece() -> None:
    """A part without vertices has no convex piece and is listed; all others have one."""
    bare = ("LeftHand", "Neck")
    skin = tuple(part for part in PART_NAMES if part not in bare)
    figure = figure_of(read_humanoid(humanoid_file(Model(skin=skin))).humanoid)
    assert set(figure.without_piece) == set(bare)
    assert not figure.absent


@pytest.mark.parametrize("model", [Model(up="z"), Model(units_per_metre=100.0)])
def test_changes_to_a_model_are_noted(model: Model) -> None:
    """A model that was turned upright or converted from another unit has a note."""
    assert len(read_humanoid(humanoid_file(model)).humanoid.notes) == 1
    assert not read_humanoid(humanoid_file()).humanoid.notes


def test_a_model_of_no_persons_size_has_its_proportions() -> None:
    """A model of 42 m is read with a person's stature and a note."""
    humanoid = read_humanoid(humanoid_file(Model(units_per_metre=25.0))).humanoid
    assert humanoid.stature_m == pytest.approx(1.75)
    assert humanoid.notes
    hips = humanoid.parts["Hips"].place_m[1] / humanoid.stature_m
    assert hips == pytest.approx(places()["Hips"][1] / STATURE_M, abs=1e-6)
