"""Tests that the avatar's model in motion stands, follows, touches and stays stable."""

from dataclasses import replace
from math import radians

import mujoco
import numpy as np
import pytest

from app.science.avatar.body.body import build_body
from app.science.avatar.body.masses import body_masses
from app.science.avatar.body.parts import FINGER_PARTS, PART_NAMES
from app.science.avatar.configuration.model_options import TIMESTEP_S, ModelOptions
from app.science.avatar.mjcf.gains import default_settings
from app.science.avatar.mjcf.mjcf import build_mjcf, driven_axes
from app.science.avatar.mjcf.scene import LooseBox, Scene, SceneBox
from app.simulated_people.visits import WITHOUT_FINGERS_STEP_S
from tests.science.avatar.bodies import (
    CARRIED,
    EMPTY,
    NO_FINGERS,
    WELDED,
    loaded,
    mjcf_of,
    settings_of,
    warnings_of,
)

WALL = SceneBox("wall", (0.0, 1.43, -0.5), (1.5, 0.6, 0.005))


@pytest.mark.parametrize("hips", ["carried", "welded"])
@pytest.mark.parametrize("floor", [True, False])
def test_it_stands_still(hips: str, *, floor: bool) -> None:
    """After 5 s at zero targets no joint is bent by 1.5 degrees, without drift or warning."""
    options = WELDED if hips == "welded" else CARRIED
    body = build_body(1.75)
    model, data = loaded(mjcf_of(body, scene=Scene(floor=floor), options=options))
    mujoco.mj_step(model, data, nstep=1500)
    before = data.qpos.copy()
    mujoco.mj_step(model, data, nstep=1000)
    assert data.time == pytest.approx(2500 * TIMESTEP_S)
    assert warnings_of(data) == 0
    assert np.abs(data.qpos - before).max() < 1e-5
    assert np.degrees(np.abs(data.qpos[-len(driven_axes(body, settings_of(body))) :]).max()) < 1.5
    assert np.abs(data.body("Hips").xpos - (0.0, 0.545 * 1.75, 0.0)).max() < 1e-3


def test_a_target_is_followed_and_clamped_to_the_limits() -> None:
    """An elbow with a target of 200 degrees bends to its limit of 150."""
    body = build_body(1.75)
    model, data = loaded(mjcf_of(body, options=ModelOptions(gravity=False)))
    motor = model.actuator("LeftLowerArmY").id
    data.ctrl[2 * motor] = radians(200.0)
    mujoco.mj_step(model, data, nstep=1000)
    assert np.degrees(data.joint("LeftLowerArmY").qpos[0]) == pytest.approx(150.0, abs=0.3)


def test_added_latency_can_be_changed_while_the_model_runs() -> None:
    """A motor with a delay of 100 ms starts 100 ms late, within two steps; the maximum is 1 s."""
    body = build_body(1.75, parts=NO_FINGERS)
    model, data = loaded(mjcf_of(body, options=ModelOptions(gravity=False)))
    motor = model.actuator("LeftLowerArmY").id
    model.actuator_delay[motor] = 0.1
    data.ctrl[2 * motor] = radians(30.0)
    started: list[float] = []
    while data.time < 0.2:
        mujoco.mj_step(model, data)
        if abs(data.joint("LeftLowerArmY").qvel[0]) > 1e-3:
            started.append(float(data.time))
    assert started[0] == pytest.approx(0.1, abs=3 * TIMESTEP_S)
    assert model.actuator_history[motor, 0] * TIMESTEP_S >= 1.0


@pytest.mark.parametrize("hips", ["carried", "welded"])
def test_a_hand_at_two_metres_a_second_stops_at_a_wall(hips: str) -> None:
    """A hand at 2 m/s enters a wall by at most 5 mm and never passes it."""
    options = WELDED if hips == "welded" else CARRIED
    model, data = loaded(mjcf_of(build_body(1.75), scene=Scene((WALL,)), options=options))
    fastest, deepest = _beaten_against_the_wall(model, data)
    assert fastest > 1.8
    assert -0.005 <= deepest < -0.0005
    assert data.body("LeftMiddleDistal").xpos[2] > -0.5
    assert warnings_of(data) == 0


def test_a_hand_without_fingers_stops_at_a_wall_in_longer_steps_too() -> None:
    """With the steps of a pilot's body without fingers, a hand enters a wall by at most 6 mm."""
    options = replace(CARRIED, step_s=WITHOUT_FINGERS_STEP_S)
    body = build_body(1.75, parts=NO_FINGERS)
    model, data = loaded(mjcf_of(body, scene=Scene((WALL,)), options=options))
    assert model.opt.timestep == pytest.approx(0.003)
    fastest, deepest = _beaten_against_the_wall(model, data)
    assert fastest > 1.8
    assert -0.006 <= deepest < -0.0005
    assert data.body("LeftHand").xpos[2] > -0.5
    assert warnings_of(data) == 0


def _beaten_against_the_wall(model: mujoco.MjModel, data: mujoco.MjData) -> tuple[float, float]:
    """Swing the left arm into `WALL`; return its fastest speed, m/s, and its least distance, m."""
    motor, geom, step_s = (
        model.actuator("LeftUpperArmY").id,
        model.geom("wall").id,
        model.opt.timestep,
    )
    deepest, fastest = 0.0, 0.0
    for step in range(round(1.4 / step_s)):
        angle = min(step * step_s * 3.5, 1.0)
        data.ctrl[2 * motor : 2 * motor + 2] = angle, 3.5 if angle < 1.0 else 0.0
        hand = np.array(data.body("LeftHand").xpos)
        mujoco.mj_step(model, data)
        speed = float(np.linalg.norm(data.body("LeftHand").xpos - hand)) / step_s
        touching = [c for c in data.contact if geom in (c.geom1, c.geom2)]
        fastest = max(fastest, speed if not touching else 0.0)
        deepest = min([deepest, *(c.dist for c in touching)])
    return fastest, deepest


def test_jumping_targets_never_explode() -> None:
    """A hundred jumps of all targets over their range cause neither a warning nor a reset."""
    model, data = loaded(mjcf_of(build_body(1.75), scene=Scene()))
    rng = np.random.default_rng(1)
    for _ in range(100):
        data.ctrl[0::2] = rng.uniform(model.jnt_range[:, 0], model.jnt_range[:, 1])
        mujoco.mj_step(model, data, nstep=20)
    assert warnings_of(data) == 0
    assert data.time == pytest.approx(2000 * TIMESTEP_S)
    assert np.isfinite(data.qpos).all()


@pytest.mark.parametrize("hips", ["carried", "welded"])
@pytest.mark.parametrize(("stature_m", "mass_kg"), [(1.5, 45.0), (1.75, 72.0), (2.0, 120.0)])
def test_limbs_come_to_rest_after_a_jump(hips: str, stature_m: float, mass_kg: float) -> None:
    """Two seconds after a jump of all targets no limb oscillates, whatever the body."""
    body = build_body(stature_m, parts=NO_FINGERS)
    masses = body_masses(body, mass_kg)
    options = ModelOptions(hips="welded" if hips == "welded" else "carried", self_collision=False)
    settings = default_settings(body, masses)
    model, data = loaded(build_mjcf(body, masses, settings, scene=EMPTY, options=options))
    rng = np.random.default_rng(5)
    ranges = model.jnt_range[-model.nactuator :]
    data.ctrl[0::2] = rng.uniform(ranges[:, 0], ranges[:, 1])
    mujoco.mj_step(model, data, nstep=1000)
    assert np.abs(data.qvel).max() < 0.02
    assert warnings_of(data) == 0


def test_a_hand_touches_the_chest_and_the_arm_passes_it() -> None:
    """With crossed arms the hands touch the torso and the arms pass through it."""
    model, data = loaded(mjcf_of(build_body(1.75), options=ModelOptions(gravity=False)))
    targets = {"LeftUpperArmY": 130.0, "LeftLowerArmY": 100.0, "LeftUpperArmZ": -25.0}
    pairs: set[frozenset[str]] = set()
    for name, angle in targets.items():
        data.ctrl[2 * model.actuator(name).id] = radians(angle)
    for _ in range(750):
        mujoco.mj_step(model, data)
        for contact in data.contact:
            geoms = (model.geom(contact.geom1), model.geom(contact.geom2))
            pairs.add(frozenset(str(model.body(g.bodyid[0]).name) for g in geoms))
    assert pairs
    assert all(any("Left" in n and "Arm" not in n for n in pair) for pair in pairs)


def test_without_self_collision_only_the_scene_is_touched() -> None:
    """Without self-collision the only contacts of a standing body are its feet on the floor."""
    body = build_body(1.75)
    options = ModelOptions(self_collision=False, gravity=False)
    model, data = loaded(mjcf_of(body, scene=Scene(), options=options))
    data.ctrl[2 * model.actuator("LeftUpperArmY").id] = radians(130.0)
    data.ctrl[2 * model.actuator("LeftLowerArmY").id] = radians(150.0)
    mujoco.mj_step(model, data, nstep=500)
    floor = model.geom("floor").id
    assert all(floor in (contact.geom1, contact.geom2) for contact in data.contact)


@pytest.mark.parametrize(
    "absent",
    [
        [part for part in FINGER_PARTS if "Little" in part],
        ["Chest", "UpperChest", "Neck", "LeftShoulder", "RightShoulder", "LeftToes", "RightToes"],
        ["LeftIndexDistal", "RightThumbIntermediate"],
    ],
)
def test_a_model_that_lacks_parts_stands_too(absent: list[str]) -> None:
    """Models with four fingers, two finger segments or Unity's minimal bones stand as well."""
    body = build_body(1.75, parts=[part for part in PART_NAMES if part not in absent])
    model, data = loaded(mjcf_of(body, scene=Scene()))
    mujoco.mj_step(model, data, nstep=500)
    assert mujoco.mj_getTotalmass(model) == pytest.approx(72.0, abs=1e-9)
    assert np.degrees(np.abs(data.qpos).max()) < 1.5
    assert warnings_of(data) == 0


def test_a_motor_without_torque_lets_the_limb_hang() -> None:
    """A maximum torque of zero means no torque, not unlimited torque."""
    body = build_body(1.75, parts=NO_FINGERS)
    settings = settings_of(body)
    settings["LeftUpperArmZ"] = replace(settings["LeftUpperArmZ"], max_torque_nm=0.0)
    model, data = loaded(mjcf_of(body, settings=settings))
    mujoco.mj_step(model, data, nstep=200)
    assert np.degrees(data.joint("LeftUpperArmZ").qpos[0]) < -30.0


def test_a_loose_box_hovers_until_it_is_dropped() -> None:
    """A box that falls leaves the avatar's hinges first, hovers weightless, then falls freely."""
    box = LooseBox("box", (0.0, 4.0, 2.0), (0.1, 0.1, 0.1), 2.0)
    body = build_body(1.75, parts=NO_FINGERS)
    model, data = loaded(mjcf_of(body, scene=Scene(loose=(box,))))
    plain, _ = loaded(mjcf_of(body, scene=Scene()))
    assert [model.joint(row).name for row in range(plain.njnt)] == [
        plain.joint(row).name for row in range(plain.njnt)
    ]
    for _ in range(100):
        mujoco.mj_step(model, data)
    assert data.body("box").xpos == pytest.approx((0.0, 4.0, 2.0), abs=1e-9)
    model.body_gravcomp[model.body("box").id] = 0.0
    steps = 250
    for _ in range(steps):
        mujoco.mj_step(model, data)
    # Semi-implicit steps: the sum 1 + 2 + ... + n of g dt^2.
    fallen = 9.81 * TIMESTEP_S**2 * steps * (steps + 1) / 2.0
    assert data.joint("box").qpos[1] == pytest.approx(4.0 - fallen, abs=1e-6)
    for _ in range(1000):
        mujoco.mj_step(model, data)
    assert data.body("box").xpos[1] == pytest.approx(0.1, abs=2e-3)
    assert warnings_of(data) == 0
