"""Tests of the settings of an avatar that can be changed while it runs."""

import math

import numpy as np
import pytest

from app.science.avatar.body.parts import AXES, AXIS_NAMES
from app.science.avatar.configuration.groups import axes_of
from app.science.avatar.mjcf.hinge_table import SimulationError
from app.science.avatar.mjcf.scene import Scene, SceneBox
from tests.science.avatar.captured import RATE_HZ
from tests.science.avatar.simulated import angle_of, angles, avatar, run


def test_a_locked_arm_is_held_while_the_rest_moves() -> None:
    """Locked axes stay within a degree and move again when they are unlocked."""
    body = avatar()
    arm = [name for name in axes_of("left_arm") if name in body.axis_names]
    body.switches.hold(arm)
    columns = [AXIS_NAMES.index(name) for name in arm]
    widest = 0.0
    for frame in range(1, 181):
        body.set_targets(np.full(len(AXES), 0.3 * math.sin(frame / 8)))
        body.step_to(frame / RATE_HZ)
        widest = max(widest, float(np.abs(body.state().angles_rad[columns]).max()))
    assert math.degrees(widest) < 1.0
    body.switches.release()
    run(body, angles(LeftLowerArmY=0.5), 60)
    assert angle_of(body, "LeftLowerArmY") == pytest.approx(0.5, abs=0.02)


def test_colliders_are_switched_while_it_runs() -> None:
    """An arm passes through a wall while its colliders are switched off."""
    wall = Scene((SceneBox("wall", (-0.8, 1.4, -0.31), (0.5, 0.6, 0.01)),), floor=False)
    body = avatar(wall)
    for part in ("LeftHand", "LeftLowerArm", "LeftUpperArm"):
        body.switches.set_collider(part, on=False)
    run(body, angles(LeftUpperArmY=1.0), 90)
    assert angle_of(body, "LeftUpperArmY") == pytest.approx(1.0, abs=0.02)
    assert not body.contacts()
    with pytest.raises(SimulationError, match="LeftWing"):
        body.switches.set_collider("LeftWing", on=True)


def test_self_collision_is_a_switch() -> None:
    """A hand stops at the thigh only while self-collision is on."""
    into_the_thigh = angles(
        RightUpperArmZ=-1.9, RightUpperArmX=-0.5, RightUpperArmY=0.0, RightLowerArmY=0.2
    )
    touching, passing = avatar(), avatar()
    passing.switches.set_self_collision(on=False)
    for body in (touching, passing):
        run(body, into_the_thigh, 90)
    pairs = {(contact.part, contact.other) for contact in touching.contacts()}
    assert ("RightUpperLeg", "RightHand") in pairs
    assert not passing.contacts()


def test_gravity_is_a_switch() -> None:
    """Without gravity an outstretched arm does not sag."""
    body = avatar()
    body.switches.set_gravity(on=False)
    run(body, angles(), 90)
    assert abs(angle_of(body, "LeftUpperArmZ")) < 1e-9
