"""Tests of the error with which a body follows a movement, depending on its gains."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from app.science.avatar.body.parts import AXIS_NAMES
from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.tuning import TuningError, follow_capture, track
from app.science.rotations import identity
from app.science.skeleton import JOINT_INDEX, Movement
from tests.science.avatar.captured import STATURE_M, WALK, captured

LEGS = tuple(
    f"{side}{part}"
    for side in ("Left", "Right")
    for part in ("UpperLeg", "LowerLeg", "Foot", "Toes")
)


def _standing(frames: int) -> Movement:
    rotations = np.broadcast_to(identity(len(JOINT_INDEX)), (frames, len(JOINT_INDEX), 4)).copy()
    hips = np.tile((0.0, 0.545 * STATURE_M, 0.0), (frames, 1))
    return Movement(90.0, hips, rotations)


def test_a_weightless_body_that_stands_has_no_error() -> None:
    """A weightless standing body has no error; every driven axis has a figure, locked ones none."""
    configuration = replace(default_configuration(), gravity=False)
    found = track(configuration, STATURE_M, _standing(90))
    assert found.frames == 90 - 1 - 45
    assert set(AXIS_NAMES) - set(found.rms_deg) == {"LeftLowerArmZ", "RightLowerArmZ"}
    assert max(found.rms_deg.values()) < 0.05


def test_axes_of_legs_that_touch_the_floor_are_reported_separately() -> None:
    """Errors of legs pressed into the floor are reported separately from all others."""
    standing = _standing(90)
    standing.root_positions_m[:, 1] -= 0.05
    found = follow_capture(default_configuration(), STATURE_M, standing).on_floor
    assert {"LeftFoot, floor", "RightFoot, floor"} <= set(found.touches)
    assert found.touching.mean_deg > 10.0 * found.free.mean_deg
    legs = sum(name.startswith(LEGS) for name in found.rms_deg)
    assert found.touching.samples == legs * found.frames
    assert found.free.samples + found.touching.samples == found.clamped.samples
    without = follow_capture(default_configuration(), STATURE_M, standing).alone
    assert not without.touches
    assert without.touching.samples == 0
    assert without.free == without.clamped


def test_the_error_that_the_limits_cause_is_reported() -> None:
    """A head that nods by 40 degrees is clamped to 22.5; only the unclamped error has the rest."""
    bent = _standing(90)
    half = np.radians(20.0)
    bent.rotations[:, JOINT_INDEX["Head"]] = (np.cos(half), -np.sin(half), 0.0, 0.0)
    found = track(replace(default_configuration(), gravity=False), STATURE_M, bent)
    driven = len(found.rms_deg)
    assert found.clipped_share == pytest.approx(1.0 / driven, abs=1e-9)
    missed = found.unclamped.mean_deg - found.clamped.mean_deg
    assert missed == pytest.approx(17.5 / driven, abs=0.01)


def test_weaker_gains_follow_a_walk_worse(shared_data: Path) -> None:
    """Dividing kp by four and kd by two raises a walk's mean error by more than half."""
    usual = default_configuration()
    weak = {
        name: own.with_values(kp=own.kp / 4.0, kd=own.kd / 2.0) for name, own in usual.axes.items()
    }
    walk = captured(shared_data, WALK)
    found = track(usual, STATURE_M, walk)
    worse = track(replace(usual, axes=weak), STATURE_M, walk)
    assert found.mean_deg <= 1.5
    assert found.p95_deg <= 5.0
    assert worse.mean_deg > 1.5 * found.mean_deg


def test_a_movement_that_is_too_short_is_rejected() -> None:
    """A movement that is shorter than the half second to settle is rejected."""
    with pytest.raises(TuningError, match="46"):
        track(default_configuration(), STATURE_M, _standing(20))
