"""Laws of the settings in force: they are applied as a whole, and taken back without a trace."""

import math
from dataclasses import replace

import mujoco
import numpy as np
import pytest

from app.protocol import AvatarChanges, settings_in_force
from app.science.avatar.body import AXIS_NAMES, PART_NAMES, SWITCHABLE_LAYERS
from app.science.avatar.configuration import as_configured, axes_of
from app.science.avatar.mjcf import SimulationError, avatar_model
from app.science.avatar.simulation import PhysicsAvatar
from app.science.avatar.simulation.switches import CAST_SPEED_RAD_S
from tests.science.avatar.captured import RATE_HZ, STATURE_M
from tests.science.avatar.simulated import EMPTY, angle_of, angles, avatar, model, run

CONFIGURATION = model().configuration
EVERYTHING = AvatarChanges.model_validate(
    {
        "gravity": False,
        "self_collision": True,
        "colliders": [{"group": "left_arm", "kind": "none"}],
        "layers": [
            {"layers": ["left_hand", "torso"], "collide": False},
            {"layers": ["left_arm", "torso"], "collide": True},
        ],
        "casts": [{"group": "right_arm", "held_deg": {"RightLowerArmY": 90.0}}],
        "gains": [
            {"motors": "left_leg", "kp_factor": 0.5, "max_torque_factor": 0.1},
            {"motors": "HeadX", "kd_nm_s_per_rad": 1.0},
        ],
    }
)


def everything_of(body: PhysicsAvatar) -> dict[str, bytes]:
    """Return every array of a model, and its options, as bytes."""
    found: dict[str, bytes] = {}
    for owner in (body.model, body.model.opt):
        for name in dir(owner):
            value = getattr(owner, name)
            if isinstance(value, np.ndarray):
                found[name] = value.tobytes()
    return found


def test_changes_that_are_taken_back_leave_no_trace() -> None:
    """After changes were applied and taken back, every array of the model is as it was built."""
    body = avatar()
    built = everything_of(body)
    body.switches.apply(settings_in_force(CONFIGURATION, EVERYTHING))
    changed = {name for name, value in everything_of(body).items() if value != built[name]}
    expected = {"gravity", "geom_contype", "jnt_range", "actuator_biasprm", "actuator_forcerange"}
    assert expected <= changed
    body.switches.apply(as_configured(CONFIGURATION))
    assert everything_of(body) == built


def test_the_order_in_which_changes_were_made_does_not_matter() -> None:
    """A body that missed a change and gets the next one has the same model as one that did not."""
    first = AvatarChanges.model_validate({"gains": [{"motors": "all", "kp_factor": 0.2}]})
    missed, followed = avatar(), avatar()
    followed.switches.apply(settings_in_force(CONFIGURATION, first))
    for body in (missed, followed):
        body.switches.apply(settings_in_force(CONFIGURATION, EVERYTHING))
    assert everything_of(missed) == everything_of(followed)


def test_gains_given_later_are_those_of_a_model_built_with_them() -> None:
    """A model whose gains are changed while it runs equals one that was built with these gains."""
    change = AvatarChanges.model_validate(
        {"gains": [{"motors": "all", "kp_factor": 0.3, "kd_factor": 2.0, "max_torque_factor": 0.5}]}
    )
    settings = settings_in_force(CONFIGURATION, change)
    body = avatar()
    body.switches.apply(settings)
    other = replace(CONFIGURATION, axes={**CONFIGURATION.axes, **settings.axes})
    built = mujoco.MjModel.from_xml_string(avatar_model(other, STATURE_M, scene=EMPTY).mjcf)
    for name in ("actuator_biasprm", "actuator_gainprm", "actuator_forcerange"):
        np.testing.assert_allclose(getattr(body.model, name), getattr(built, name), rtol=1e-11)


def test_weaker_motors_follow_worse() -> None:
    """A swinging arm is off by 2 deg with its own gains, and by over 30 with a twentieth of them.

    With its own gains given back, it is off by as little as before.
    """
    weak = AvatarChanges.model_validate(
        {"gains": [{"motors": "left_arm", "kp_factor": 0.05, "kd_factor": 0.05}]}
    )
    body = avatar()
    usual = worst_deg(body)
    body.switches.apply(settings_in_force(CONFIGURATION, weak))
    weakened = worst_deg(body)
    body.switches.apply(as_configured(CONFIGURATION))
    run(body, angles(), 90)
    assert usual < 2.0
    assert weakened > 30.0
    assert worst_deg(body) == pytest.approx(usual, abs=0.2)


def worst_deg(body: PhysicsAvatar) -> float:
    """Let an upper arm swing twice; return the largest distance from its target in degrees."""
    start_s, worst = body.time_s, 0.0
    for frame in range(1, 91):
        target = 0.4 * math.sin(2.0 * math.pi * frame / 45)
        body.set_targets(angles(LeftUpperArmZ=target))
        body.step_to(start_s + frame / RATE_HZ)
        worst = max(worst, abs(target - angle_of(body, "LeftUpperArmZ")))
    return math.degrees(worst)


def test_a_cast_moves_to_its_angle_and_holds_it() -> None:
    """A cast reaches its angle at its speed, and then holds it within a degree.

    The rest of the body is thrown about meanwhile, in gravity.
    """
    cast = {"casts": [{"group": "left_arm", "held_deg": {"LeftLowerArmY": 90.0}}]}
    body = avatar()
    run(body, angles(), 30)
    before = body.state().angles_rad
    body.switches.apply(settings_in_force(CONFIGURATION, AvatarChanges.model_validate(cast)))
    held = [name for name in axes_of("left_arm") if name in body.axis_names]
    assert body.switches.held == frozenset(held)
    start_s, errors, fastest, previous = body.time_s, [], 0.0, 0.0
    for frame in range(1, 271):
        body.set_targets(np.full(len(AXIS_NAMES), 0.5 * math.sin(frame / 6)))
        body.step_to(start_s + frame / RATE_HZ)
        now = body.state().angles_rad
        elbow = now[AXIS_NAMES.index("LeftLowerArmY")]
        fastest, previous = max(fastest, abs(elbow - previous) * RATE_HZ), elbow
        if frame > 1.2 * math.radians(90.0) / CAST_SPEED_RAD_S * RATE_HZ:
            goal = [
                math.radians(90.0) if name == "LeftLowerArmY" else before[AXIS_NAMES.index(name)]
                for name in held
            ]
            errors.append(np.abs(now[[AXIS_NAMES.index(name) for name in held]] - goal).max())
    assert math.degrees(max(errors)) < 1.0
    assert fastest < 2.0 * CAST_SPEED_RAD_S
    assert body.health.restored == 0


def test_a_cast_at_an_earlier_angle_is_put_on_again() -> None:
    """A new run of the body holds an axis at the angle at which an earlier run held it."""
    cast = AvatarChanges.model_validate({"casts": [{"group": "LeftLowerArm"}]})
    first, second = avatar(), avatar()
    run(first, angles(LeftLowerArmY=1.0), 60)
    settings = settings_in_force(CONFIGURATION, cast)
    first.switches.apply(settings)
    second.switches.apply(settings, first.switches.held_rad)
    run(second, angles(), 120)
    assert angle_of(second, "LeftLowerArmY") == pytest.approx(
        first.switches.held_rad["LeftLowerArmY"], abs=math.radians(0.5)
    )


def test_parts_without_colliders_pass_through_and_layers_can_be_switched() -> None:
    """A hand stops at the thigh only while both layers collide and the hand has a collider."""
    into_the_thigh = angles(
        RightUpperArmZ=-1.9, RightUpperArmX=-0.5, RightUpperArmY=0.0, RightLowerArmY=0.2
    )

    def touches(content: dict[str, object]) -> bool:
        body = avatar()
        change = AvatarChanges.model_validate(content)
        body.switches.apply(settings_in_force(CONFIGURATION, change))
        run(body, into_the_thigh, 90)
        return bool(body.contacts())

    assert touches({})
    assert not touches({"colliders": [{"group": "right_arm", "kind": "none"}]})
    off = [{"layers": ["right_hand", layer], "collide": False} for layer in ("right_leg", "torso")]
    assert not touches({"layers": off})
    assert not touches({"self_collision": False})


@pytest.mark.parametrize("pair", sorted(map(sorted, SWITCHABLE_LAYERS)), ids="-".join)
def test_layers_that_can_be_switched_on_do_not_overlap_at_rest(pair: list[str]) -> None:
    """No pair of layers that can be made to collide touches in the T-pose or with hanging arms."""
    body = avatar(fingers=True)
    change = AvatarChanges.model_validate({"layers": [{"layers": pair, "collide": True}]})
    body.switches.apply(settings_in_force(model(fingers=True).configuration, change))
    for pose in (angles(), angles(LeftUpperArmZ=-1.2, RightUpperArmZ=-1.2)):
        run(body, pose, 45)
        assert not body.contacts()


def test_an_axis_without_a_hinge_is_refused() -> None:
    """Holding or driving an axis without a hinge is refused with its name."""
    body = avatar()
    with pytest.raises(SimulationError, match="LeftThumbProximalX"):
        body.switches.hold_at({"LeftThumbProximalX": 0.0})
    with pytest.raises(SimulationError, match="cannot be held at 9 rad"):
        body.switches.hold_at({"LeftLowerArmY": 9.0})
    assert body.switches.held == frozenset()
    assert set(as_configured(CONFIGURATION).colliders) == set(PART_NAMES)
