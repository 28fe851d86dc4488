"""Tests of the targets of limbs whose parts return to their own direction."""

import json
import math

import numpy as np
import pytest

from app.science.avatar.body import AXES, AXIS_NAMES
from app.science.avatar.configuration import LIMBS
from app.science.avatar.targets import LimbYield
from app.science.rotations import FloatArray
from tests.science.avatar.targets.limb_yield_vectors import FILE, answered


def _angles(**named: float) -> FloatArray:
    angles = np.zeros(len(AXIS_NAMES))
    for name, value in named.items():
        angles[AXIS_NAMES.index(name)] = value
    return angles


def _settled(rule: LimbYield, targets: FloatArray, actual: FloatArray) -> FloatArray:
    for _ in range(200):
        rule.note(targets, actual, 0.02)
    return rule.commands(targets)


def test_the_stored_commands_are_still_those_of_the_rule() -> None:
    """The rule gives the stored commands, to which the browser's is held."""
    vectors = json.loads(FILE.read_text(encoding="utf-8"))
    for case in vectors["cases"]:
        found = answered(vectors["frames"], tuple(case["limbs"]))
        np.testing.assert_allclose(found, case["commands_rad"], rtol=0.0, atol=1e-12)


def test_a_knee_takes_back_what_the_thigh_was_turned() -> None:
    """A thigh turned about the knee's axis changes the knee by as much, the other way, no more."""
    targets = _angles(LeftUpperLegX=0.4, LeftLowerLegX=0.7)
    pushed = _angles(LeftUpperLegX=0.6, LeftLowerLegX=0.7)
    commands = _settled(LimbYield(("left_leg",)), targets, pushed)
    turned = commands - targets
    knee = AXIS_NAMES.index("LeftLowerLegX")
    directions = {axis.name: axis.direction for axis in AXES}
    parallel = np.dot(directions["LeftUpperLegX"], directions["LeftLowerLegX"])
    assert turned[knee] == pytest.approx(-0.2 * parallel, abs=1e-9)
    foot = [AXIS_NAMES.index(f"LeftFoot{letter}") for letter in "XYZ"]
    # The shin itself has turned with the thigh, so the foot takes it back as well.
    assert np.linalg.norm(turned[foot]) == pytest.approx(0.2, rel=0.05)
    assert np.count_nonzero(np.abs(turned) > 1e-12) <= 1 + 3 + 1 + 1


def test_other_limbs_and_undisturbed_ones_keep_their_targets() -> None:
    """At its target a limb is commanded its target, to the bit; other limbs always are."""
    targets = _angles(LeftUpperLegX=0.4, LeftLowerLegX=0.7, RightUpperArmY=0.3)
    rule = LimbYield(LIMBS)
    np.testing.assert_array_equal(_settled(rule, targets, targets), targets)
    pushed = targets + _angles(RightUpperLegX=0.5, RightUpperArmZ=0.5)
    commands = _settled(LimbYield(("right_leg",)), targets, pushed)
    changed = {name for name, one in zip(AXIS_NAMES, commands - targets, strict=True) if one}
    assert changed
    assert all(name.startswith(("RightLowerLeg", "RightFoot", "RightToes")) for name in changed)


def test_the_deviation_is_followed_slowly_and_forgotten() -> None:
    """After a tenth of a second 63 % of a deviation are compensated; a new pose begins afresh."""
    targets, pushed = _angles(), _angles(LeftUpperLegX=0.2)
    rule = LimbYield(("left_leg",))
    for _ in range(10):
        rule.note(targets, pushed, 0.01)
    knee = AXIS_NAMES.index("LeftLowerLegX")
    assert abs(rule.commands(targets)[knee]) == pytest.approx(0.2 * (1.0 - math.exp(-1.0)))
    rule.forget()
    np.testing.assert_array_equal(rule.commands(targets), targets)
