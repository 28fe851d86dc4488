"""Tests of a recording's joint error against the present target and the delayed command."""

import math
from collections.abc import Mapping
from functools import cache

import numpy as np
import pytest

from app.science.avatar.body.parts import AXIS_NAMES
from app.science.avatar.configuration.limits import ANATOMIC
from app.science.avatar.targets.hinge_reference import HingeReference
from app.science.avatar.targets.targets import TargetAngles, joint_rotations
from app.science.delay import delayed_pose
from app.science.joint_error.errors import (
    ERROR_AXES,
    ERROR_JOINTS,
    JointErrorError,
    JointErrorSummary,
    joint_error_summary,
)
from app.science.joint_error.recorded import (
    Recorded,
    RecordedErrors,
    ReferenceMotion,
    recorded_errors,
)
from app.science.rotations import FloatArray, from_rotation_vector, identity, multiply, normalise
from app.science.skeleton.joints import JOINT_INDEX

RATE_HZ = 90.0
FRAMES, BEGIN = 200, 30
"""Number of the participant's frames, and the first that counts; earlier ones are history."""
DELAY_FRAMES = 12
DELAY_S = DELAY_FRAMES / RATE_HZ
HEAD_LIMIT_DEG = 22.5


@cache
def hinges() -> HingeReference:
    """Return the hinge reference of a human body, built once."""
    return HingeReference(ANATOMIC)


def posed(degrees: Mapping[str, FloatArray]) -> FloatArray:
    """Return (FRAMES, 22, 4) rotations with these hinge angles and the T-pose elsewhere."""
    angles = np.zeros((FRAMES, len(AXIS_NAMES)))
    for axis, values in degrees.items():
        angles[:, AXIS_NAMES.index(axis)] = np.radians(values)
    return joint_rotations(angles, identity(FRAMES))


def of(summary: JointErrorSummary, table: str, joint: str, axis: str) -> float:
    """Return one value of an error summary, with angles in degrees."""
    value = getattr(summary, table)[ERROR_JOINTS.index(joint), ERROR_AXES.index(axis)]
    return float(value if table == "clipped_share" else math.degrees(value))


def nodding(size_deg: float) -> FloatArray:
    """Return head angles: bent forward by `size_deg` in frames 20 to 39 and upright otherwise."""
    frame = np.arange(FRAMES)
    return np.where((frame >= 20) & (frame < 40), size_deg, 0.0)


def recorded(target: FloatArray, actual: FloatArray, reference: HingeReference | None) -> Recorded:
    """Return a run whose avatar is seen from frame BEGIN on, on a clock that starts at 500 s."""
    times_s = 500.0 + np.arange(FRAMES) / RATE_HZ
    reference_motion = (
        ReferenceMotion(target) if reference is None else reference.recording(times_s, target)
    )
    frames = np.arange(BEGIN, FRAMES)
    return Recorded(times_s, reference_motion, frames, times_s[frames], actual[frames])


def clamped(target: FloatArray, delay_frames: int) -> FloatArray:
    """Return the rotations of hinges that follow exactly, within limits, some frames later."""
    angles = TargetAngles(ANATOMIC).batch(target).angles_rad
    late = np.maximum(np.arange(FRAMES) - delay_frames, 0)
    return joint_rotations(angles[late], target[:, 0])


def nodded(size_deg: float, delay_frames: int = DELAY_FRAMES) -> RecordedErrors:
    """Return the errors of an avatar that follows a nod perfectly within its limits."""
    target = posed({"HeadX": nodding(size_deg)})
    run = recorded(target, clamped(target, delay_frames), hinges())
    return recorded_errors([run], delay_frames / RATE_HZ)


def test_a_perfect_avatar_has_no_error_against_its_delayed_command() -> None:
    """A perfect avatar's error is zero against its delayed command, not against the present."""
    found = nodded(20.0)
    np.testing.assert_allclose(np.nan_to_num(found.command.max_rad), 0.0, atol=1e-9)
    assert of(found.present, "max_rad", "Head", "angle") == pytest.approx(20.0)
    # Commanded to nod until frame 39, it nods from 32 to 51: wrong in 30, 31 and from 40 on.
    share = 14 / (FRAMES - BEGIN)
    assert of(found.present, "mean_rad", "Head", "angle") == pytest.approx(20.0 * share)


def test_the_error_of_clipping_and_its_share_are_exact() -> None:
    """A nod to 40 deg at a limit of 22.5 gives an error of 17.5 deg and the exact clipped share."""
    found = nodded(40.0)
    # The head bends forward about -x, so the missing rotation is +x.
    assert of(found.command, "max_rad", "Head", "angle") == pytest.approx(40.0 - HEAD_LIMIT_DEG)
    share = 20 / (FRAMES - BEGIN)
    assert of(found.command, "mean_rad", "Head", "x") == pytest.approx(17.5 * share)
    assert of(found.command, "max_rad", "Head", "y") == pytest.approx(0.0, abs=1e-9)
    for axis, expected in (("angle", share), ("x", share), ("y", 0.0), ("z", 0.0)):
        assert of(found.command, "clipped_share", "Head", axis) == expected
    assert of(found.command, "clipped_share", "Neck", "angle") == 0.0


def test_a_clipping_belongs_to_the_time_of_the_reference() -> None:
    """Clipping counts in the reference's own frames: 10 of the present, 20 of the command."""
    found = nodded(40.0)
    samples = FRAMES - BEGIN
    assert of(found.present, "clipped_share", "Head", "x") == 10 / samples
    assert of(found.command, "clipped_share", "Head", "x") == 20 / samples


@pytest.mark.parametrize("delay_frames", [0, 5, 29])
def test_a_delay_moves_the_command_and_not_the_present(delay_frames: int) -> None:
    """Another delay changes the error against the command, not against the present target."""
    target = posed({"HeadX": nodding(20.0), "SpineY": np.linspace(-10.0, 10.0, FRAMES)})
    run = recorded(target, clamped(target, 5), hinges())
    now, later = recorded_errors([run], 0.0), recorded_errors([run], delay_frames / RATE_HZ)
    np.testing.assert_array_equal(now.present.rms_rad, later.present.rms_rad)
    largest = of(later.command, "max_rad", "Spine", "angle")
    step_deg = 20.0 / (FRAMES - 1)
    assert largest == pytest.approx(abs(delay_frames - 5) * step_deg, abs=1e-6)
    if delay_frames == 0:
        np.testing.assert_array_equal(later.command.rms_rad, later.present.rms_rad)


def test_between_two_frames_the_nearer_ones_clipping_counts() -> None:
    """Between two frames the nearer one's clipping counts: 4.6 frames as 5, 4.4 as 4."""
    target = posed({"HeadX": nodding(40.0)})
    run = recorded(target, clamped(target, 0), hinges())
    late_s = (BEGIN - 25.0) / RATE_HZ  # the first sample was commanded in frame 25

    def share(delay_s: float) -> float:
        summary = recorded_errors([run], delay_s).command
        return of(summary, "clipped_share", "Head", "x") * (FRAMES - BEGIN)

    assert share(late_s) == pytest.approx(15.0)
    assert share(late_s - 0.4 / RATE_HZ) == pytest.approx(15.0)
    assert share(late_s - 0.6 / RATE_HZ) == pytest.approx(14.0)


def test_plus_x_has_turned_too_far_about_the_parents_x() -> None:
    """A head turned 3 deg too far about its parent's x axis has an error of +3 deg about x."""
    target = posed({"HeadX": np.full(FRAMES, 10.0), "HeadY": np.full(FRAMES, 15.0)})
    actual = target.copy()
    head = JOINT_INDEX["Head"]
    extra = from_rotation_vector(np.array((math.radians(3.0), 0.0, 0.0)))
    actual[:, head] = multiply(extra, target[:, head])
    found = recorded_errors([recorded(target, actual, hinges())], DELAY_S)
    for summary in (found.present, found.command):
        assert of(summary, "mean_rad", "Head", "x") == pytest.approx(3.0)
        assert of(summary, "mean_rad", "Head", "y") == pytest.approx(0.0, abs=1e-9)


def test_runs_count_together() -> None:
    """The clipped share of a clipped and an unclipped run together is half of the former's."""
    nod, still = posed({"HeadX": nodding(40.0)}), posed({})
    runs = [recorded(target, clamped(target, 0), hinges()) for target in (nod, still)]
    alone, both = recorded_errors(runs[:1], 0.0).present, recorded_errors(runs, 0.0).present
    assert both.count[0] == 2 * alone.count[0]
    assert of(both, "clipped_share", "Head", "angle") == pytest.approx(
        of(alone, "clipped_share", "Head", "angle") / 2.0
    )


def test_a_delayed_copy_is_compared_with_the_raw_rotations_to_the_bit() -> None:
    """A delayed copy is compared with raw rotations, and has no clipped share."""
    rng = np.random.default_rng(8)
    target = normalise(rng.normal(size=(FRAMES, 22, 4)))
    target[50, 3], target[60, 4] = np.nan, 0.5
    run = recorded(target, normalise(rng.normal(size=target.shape)), None)
    run.times_s[70:72] = np.nan, 0.0
    run.actual_times_s[90] = np.nan
    found = recorded_errors([run], 0.1)
    present = joint_error_summary(target[run.partners], run.actual)
    good = np.delete(np.arange(FRAMES), (70, 71))
    valid = np.isfinite(run.actual_times_s)
    command = np.full_like(run.actual, np.nan)
    command[valid] = delayed_pose(run.times_s[good], target[good], run.actual_times_s[valid], 0.1)
    for result, expected in (
        (found.present, present),
        (found.command, joint_error_summary(command, run.actual)),
    ):
        for table in ("mean_rad", "rms_rad", "p95_rad", "max_rad", "count", "left_out"):
            np.testing.assert_array_equal(getattr(result, table), getattr(expected, table))
        assert np.isnan(result.clipped_share).all()


def test_a_recording_without_runs_is_rejected() -> None:
    """A recording without runs is rejected."""
    with pytest.raises(JointErrorError, match="at least one"):
        recorded_errors([], 0.1)
