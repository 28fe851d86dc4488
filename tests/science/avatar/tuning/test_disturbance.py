"""Tests of how a limb that is pushed gives way and comes back, stiff or soft, in both ways."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from app.science.avatar.configuration import Compliance, Configuration, LimbTargets
from app.science.avatar.mjcf import SimulationError, default_configuration
from app.science.avatar.tuning import Disturbance, Response, disturb
from app.science.rotations import FloatArray, Vector, identity
from app.science.skeleton import JOINT_INDEX

STATURE_M = 1.75
BACKWARDS: Vector = (0.0, 0.0, 1.0)
SIDEWAYS: Vector = (1.0, 0.0, 0.0)
MAY_RISE = 0.05
"""How far the energy may rise at first, as a share of that when the push ended: 2 % measured."""
TENTH = 9
"""Frames in a tenth of a second."""
DAMPED_J = 0.2
"""The stiff trunk's springs hold its weight: this energy stays."""


def _step(side: str) -> FloatArray:
    """Return a pose with one thigh raised by 30 degrees and its knee bent by 50."""
    pose = identity(len(JOINT_INDEX))
    for part, degrees in (("UpperLeg", 30.0), ("LowerLeg", -50.0)):
        half = math.radians(degrees) / 2.0
        pose[JOINT_INDEX[side + part]] = (math.cos(half), math.sin(half), 0.0, 0.0)
    return pose


def _soft(stiffness: float, targets: LimbTargets, *groups: str) -> Configuration:
    compliance = dict.fromkeys(groups, Compliance(stiffness, targets))
    return replace(default_configuration(), compliance=compliance)


@cache
def _pushed(
    stiffness: float,
    targets: LimbTargets,
    force_n: float,
    direction: Vector = BACKWARDS,
    side: str = "Left",
) -> Response:
    x, y, z = direction
    push = Disturbance(f"{side}LowerLeg", (force_n * x, force_n * y, force_n * z))
    soft = _soft(stiffness, targets, f"{side.lower()}_leg")
    return disturb(soft, STATURE_M, push, _step(side))


@pytest.mark.parametrize("force_n", [50.0, 200.0])
def test_a_soft_shin_gives_way_and_comes_back(force_n: float) -> None:
    """A soft shin gives way further than a stiff one and returns; with world targets sooner."""
    stiff = _pushed(1.0, "joint", force_n)
    joint, world = (_pushed(0.1, targets, force_n) for targets in ("joint", "world"))
    assert stiff.peak_rad < math.radians(2.0)
    assert stiff.return_s == 0.0
    assert joint.peak_rad > 5.0 * stiff.peak_rad
    assert joint.return_s is not None
    assert world.return_s is not None
    assert stiff.peak_rad < world.peak_rad < joint.peak_rad
    assert 0.0 < world.return_s < joint.return_s < 0.5
    for response in (stiff, joint, world):
        assert response.rest_rad < math.radians(0.05)
        assert response.restored == 0
        assert np.isfinite(response.energy_j).all()


@pytest.mark.parametrize("targets", ["joint", "world"])
@pytest.mark.parametrize("stiffness", [1.0, 0.1, 0.03])
@pytest.mark.parametrize("direction", [BACKWARDS, SIDEWAYS])
def test_energy_falls_after_the_push(
    targets: LimbTargets, stiffness: float, direction: Vector
) -> None:
    """After a push the energy of movement and springs falls, and nearly none is left in the end.

    World targets move springs, which adds a little at first; from one tenth of a second to the next
    the damping always takes more.
    """
    response = _pushed(stiffness, targets, 200.0, direction)
    after = response.energy_j[response.times_s > 0.2]
    assert after.max() <= (1.0 + MAY_RISE) * after[0]
    assert np.diff(after[::TENTH]).max() <= 1e-3 * after[0]
    assert after[-1] < DAMPED_J
    assert response.rest_rad < math.radians(0.5)
    assert response.restored == 0


@pytest.mark.parametrize("targets", ["joint", "world"])
def test_both_sides_give_way_alike(targets: LimbTargets) -> None:
    """A push on the right leg does what the mirrored push does on the left leg."""
    left = _pushed(0.1, targets, 150.0, SIDEWAYS)
    right = _pushed(0.1, targets, 150.0, (-1.0, 0.0, 0.0), "Right")
    np.testing.assert_allclose(right.deflection_rad, left.deflection_rad, atol=1e-6)


def test_without_a_push_all_ways_give_the_same_pose() -> None:
    """Without a force, soft or stiff, joint or world targets, a body rests in the same pose.

    Its weight is carried, so a soft leg does not sag.
    """
    stiff = replace(default_configuration(), gravity=False)
    floating = [
        disturb(replace(stiff, compliance=compliance), STATURE_M, _NOTHING, _step("Left"))
        for compliance in ({}, {"left_leg": Compliance(0.1, "world")})
    ]
    for response in floating:
        assert response.deflection_rad.max() < 1e-6
    weighing = disturb(_soft(0.03, "world", "left_leg"), STATURE_M, _NOTHING, _step("Left"))
    assert weighing.deflection_rad.max() < math.radians(0.05)


def test_a_motor_at_its_limit_is_reported() -> None:
    """A push that a weak knee cannot hold is reported as saturation, and it still comes back."""
    usual = _soft(1.0, "joint")
    knee = usual.axes["LeftLowerLegX"].with_values(max_torque_nm=20.0)
    weak = replace(usual, axes={**usual.axes, "LeftLowerLegX": knee})
    push = Disturbance("LeftLowerLeg", (0.0, 0.0, 200.0))
    response = disturb(weak, STATURE_M, push, _step("Left"))
    assert response.saturated == ("LeftLowerLegX",)
    assert 0.05 < response.saturated_share < 0.5
    assert response.return_s is not None
    assert _pushed(1.0, "joint", 50.0).saturated_share == 0.0
    with pytest.raises(SimulationError, match="no part 'Tail'"):
        disturb(weak, STATURE_M, replace(push, part="Tail"), _step("Left"))


_NOTHING = Disturbance("LeftLowerLeg", (0.0, 0.0, 0.0))
