"""Tests of the avatar as a MuJoCo model: its bodies, hinges, motors and scene."""

import hashlib
import os
import subprocess
import sys
from dataclasses import replace
from math import radians

import mujoco
import numpy as np
import pytest

from app.science.avatar.body.body import BodyError, build_body
from app.science.avatar.body.masses import body_masses
from app.science.avatar.body.parts import AXES_OF, PART_NAMES, mirrored_name
from app.science.avatar.mjcf.gains import default_settings
from app.science.avatar.mjcf.hinges import hinges_of
from app.science.avatar.mjcf.mjcf import driven_axes
from app.science.rotations import from_rotation_vector, multiply
from app.science.skeleton import JOINT_NAMES, build_skeleton, forward_kinematics
from tests.science.avatar.bodies import (
    CARRIED,
    NO_FINGERS,
    STUDY_BOXES,
    WELDED,
    loaded,
    mjcf_of,
    settings_of,
)


@pytest.mark.parametrize("hips", ["carried", "welded"])
@pytest.mark.parametrize(
    ("parts", "free", "axes"),
    [(PART_NAMES, False, 89), (PART_NAMES, True, 91), (NO_FINGERS, False, 49)],
)
def test_a_model_has_a_hinge_and_a_motor_for_each_axis(
    hips: str, parts: list[str], axes: int, *, free: bool
) -> None:
    """The 52 parts have 91 axes, two of them locked in anatomic elbows; welded hips move freely."""
    body = build_body(1.75, parts=parts)
    options = WELDED if hips == "welded" else CARRIED
    settings = settings_of(body, free=free)
    model, _ = loaded(mjcf_of(body, settings=settings, options=options))
    own = (7, 6) if hips == "welded" else (0, 0)
    assert (model.nq, model.nv) == (axes + own[0], axes + own[1])
    assert (model.nactuator, model.nu) == (axes, 2 * axes)
    names = [axis.name for axis in driven_axes(body, settings)]
    assert [model.actuator(i).name for i in range(axes)] == names
    joints = [model.joint(i).name for i in range(model.njnt)]
    assert joints[model.njnt - axes :] == names


@pytest.mark.parametrize("parts", [PART_NAMES, NO_FINGERS])
def test_the_model_weighs_what_the_body_weighs(parts: list[str]) -> None:
    """The model of a body of 72 kg weighs 72 kg, to the twelve digits that are written."""
    model, _ = loaded(mjcf_of(build_body(1.75, parts=parts)))
    assert mujoco.mj_getTotalmass(model) == pytest.approx(72.0, abs=1e-9)


@pytest.mark.parametrize("hips", ["carried", "welded"])
@pytest.mark.parametrize("stature_m", [1.5, 1.75, 2.0])
def test_it_starts_in_the_skeletons_t_pose(hips: str, stature_m: float) -> None:
    """At zero angles the 22 joints lie where the product's skeleton has them."""
    options = WELDED if hips == "welded" else CARRIED
    _, data = loaded(mjcf_of(build_body(stature_m), options=options))
    skeleton = build_skeleton(stature_m)
    identity = np.tile([1.0, 0.0, 0.0, 0.0], (len(JOINT_NAMES), 1))
    expected = forward_kinematics(skeleton, skeleton.offsets_m[0], identity).positions_m
    places = np.array([data.body(name).xpos for name in JOINT_NAMES])
    assert np.abs(places - expected).max() < 1e-11


def test_a_part_turns_by_the_product_of_its_axes() -> None:
    """A part's rotation is R(axis 1) R(axis 2) R(axis 3), in the order of the table of parts."""
    body = build_body(1.75)
    model, data = loaded(mjcf_of(body, settings=settings_of(body, free=True)))
    rng = np.random.default_rng(6)
    data.qpos[:] = rng.uniform(-0.6, 0.6, model.nq)
    mujoco.mj_forward(model, data)
    for name, part in body.parts.items():
        if part.parent is None:
            continue
        expected = np.array(data.body(part.parent).xquat)
        for axis in AXES_OF[name]:
            angle = float(data.joint(axis.name).qpos[0])
            expected = multiply(expected, from_rotation_vector(angle * np.array(axis.direction)))
        assert abs(float(np.dot(expected, data.body(name).xquat))) == pytest.approx(1.0, abs=1e-12)


@pytest.mark.parametrize("locked", ["LeftUpperArmY", "LeftUpperArmZ", "LeftUpperArmX"])
def test_a_locked_axis_stays_at_its_angle(locked: str) -> None:
    """An axis locked at 40 degrees has no hinge but still turns its part."""
    body = build_body(1.75)
    settings = settings_of(body)
    settings[locked] = replace(settings[locked], low_rad=radians(40), high_rad=radians(40))
    model, data = loaded(mjcf_of(body, settings=settings))
    angles = {"LeftUpperArmY": 0.5, "LeftUpperArmZ": -0.8, "LeftUpperArmX": 0.3}
    angles[locked] = radians(40)
    for name in set(angles) - {locked}:
        data.joint(name).qpos[0] = angles[name]
    mujoco.mj_forward(model, data)
    expected = np.array([1.0, 0.0, 0.0, 0.0])
    for axis in AXES_OF["LeftUpperArm"]:
        turn = from_rotation_vector(angles[axis.name] * np.array(axis.direction))
        expected = multiply(expected, turn)
    assert abs(float(np.dot(expected, data.body("LeftUpperArm").xquat))) == pytest.approx(1.0)
    assert model.nv == 88


def test_the_text_is_the_same_to_the_byte_in_every_process() -> None:
    """The MJCF does not depend on the process or its hash seed, to the byte."""
    code = (
        "import hashlib;"
        "from tests.science.avatar.bodies import STUDY_BOXES, mjcf_of;"
        "from app.science.avatar.body.body import build_body;"
        "print(hashlib.sha256(mjcf_of(build_body(1.75), scene=STUDY_BOXES).encode()).hexdigest())"
    )
    digests = {
        subprocess.run(
            [sys.executable, "-c", code],
            env={**os.environ, "PYTHONHASHSEED": seed},
            check=True,
            capture_output=True,
            text=True,
        ).stdout.strip()
        for seed in ("0", "4711")
    }
    here = hashlib.sha256(mjcf_of(build_body(1.75), scene=STUDY_BOXES).encode()).hexdigest()
    assert digests == {here}


def test_nothing_of_the_body_touches_itself_in_the_t_pose() -> None:
    """In the T-pose the body has no contact with itself when self-collision is on."""
    _, data = loaded(mjcf_of(build_body(1.75)))
    assert data.ncon == 0


def test_hinges_know_the_inertia_they_move() -> None:
    """A hinge's inertia is the greater mass-matrix diagonal of straight and of bent limbs."""
    body = build_body(1.75)
    masses = body_masses(body, 72.0)
    settings = default_settings(body, masses)
    model, data = loaded(mjcf_of(body, settings=settings))
    matrix = np.zeros((2, model.nv, model.nv))
    mujoco.mj_fullM(model, data, matrix[0])
    for name in ("LeftLowerArmY", "RightLowerArmY", "LeftLowerLegX", "RightLowerLegX"):
        data.joint(name).qpos[0] = radians(90.0)
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, matrix[1])
    hinges = hinges_of(body, masses)
    ours = np.array([hinges[axis.name].inertia_kg_m2 for axis in driven_axes(body, settings)])
    greater = np.maximum(np.diag(matrix[0]), np.diag(matrix[1]))
    assert greater == pytest.approx(ours, rel=1e-9)


def test_both_sides_are_driven_alike() -> None:
    """Hinge inertias, gains and limits are equal on the left and the right."""
    body = build_body(1.75)
    model, _ = loaded(mjcf_of(body))
    for axis in driven_axes(body, settings_of(body)):
        one, two = model.joint(axis.name), model.joint(mirrored_name(axis.name))
        assert one.range == pytest.approx(two.range)
        assert one.damping == pytest.approx(two.damping)
        one, two = model.actuator(axis.name), model.actuator(mirrored_name(axis.name))
        assert one.biasprm == pytest.approx(two.biasprm)
        assert one.forcerange == pytest.approx(two.forcerange)


def test_an_axis_without_settings_is_rejected() -> None:
    """An axis without settings raises an error that names it."""
    body = build_body(1.75)
    settings = settings_of(body)
    del settings["HeadY"]
    with pytest.raises(BodyError, match="HeadY has no settings"):
        mjcf_of(body, settings=settings)


def test_the_studys_boxes_stand_in_the_scene_under_their_names() -> None:
    """The study's panels, walls and targets are immovable geoms; the start square is a mark."""
    model, _ = loaded(mjcf_of(build_body(1.75), scene=STUDY_BOXES))
    for box in STUDY_BOXES.boxes:
        geom = model.geom(box.name)
        assert geom.bodyid[0] == 0
        assert tuple(geom.pos) == pytest.approx(box.center_m)
        assert tuple(geom.size) == pytest.approx(box.half_size_m)
        assert bool(geom.conaffinity[0]) == (box.name != "foot/start")
    names = {box.name for box in STUDY_BOXES.boxes}
    assert {"hand/1/panel", "hand/2/left", "hand/target", "foot/1/front", "foot/start"} <= names
