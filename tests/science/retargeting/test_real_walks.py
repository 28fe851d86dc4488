"""Tests of CMU's captured walks on avatars: steps, lifts and foot sliding of real people."""

from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from app.adapters.captures.reader import read_capture_file
from app.science.fitting import fit_skeleton
from app.science.retargeting.gait import walk_figures
from app.science.retargeting.joint_map import JointMap, propose_joint_map
from app.science.retargeting.leg_angles import leg_angles
from app.science.retargeting.legs import legs_of
from app.science.retargeting.pipeline import Retargeted, retarget_motion
from app.science.retargeting.reference_avatars import (
    PAPER_STATURES_M,
    REFERENCE_JOINT_MAP,
    reference_avatar,
)
from app.science.retargeting.verification import verify
from app.science.rig import BodyMotion, MarkerMotion, RigMotion

_WALKS = ("02_01", "06_01", "12_02")


@pytest.fixture(params=_WALKS)
def walk(request: pytest.FixtureRequest, shared_data: Path) -> tuple[RigMotion, JointMap]:
    """Return one of CMU's straight walks with its proposed joint map."""
    motion = read_capture_file(shared_data / f"motion/cmu_bvh/{request.param}.bvh").motion
    assert isinstance(motion, RigMotion)
    return motion, propose_joint_map(motion.rig).joint_map


def _onto(
    walk: tuple[RigMotion, JointMap],
    stature_m: float,
    share: float | None = None,
    *,
    lock: bool = False,
) -> Retargeted:
    avatar = reference_avatar(stature_m, thigh_share=share)
    return retarget_motion(*walk, avatar, REFERENCE_JOINT_MAP, lock=lock)


def _largest_jerk_m_s(motion: RigMotion) -> float:
    change = np.diff(motion.world()[0], n=2, axis=0)
    return float(np.linalg.norm(change, axis=-1).max() * motion.rate_hz)


def test_the_steps_of_a_captured_person_are_human(walk: tuple[RigMotion, JointMap]) -> None:
    """Captured walks have four or more steps of 0.9 to 1.5 m between contacts, 5 to 13 cm high.

    Strides of adults at 0.8 to 1.4 m/s are that long; feet alternate.
    """
    walks = _onto(walk, 1.65).walks
    assert walks is not None
    steps = walks.source.strides
    assert len(steps) >= 4
    assert all(0.9 < step.length_m < 1.5 and 0.05 < step.height_m < 0.13 for step in steps)
    assert all(a.side != b.side for a, b in pairwise(steps))


def test_one_walk_has_the_same_steps_in_every_format(shared_data: Path) -> None:
    """Steps of the AMC (solved by CMU) and the C3D (fitted here) agree within 1 cm.

    The BVH of the same walk, by an unknown author, has a root that moves 1.06312 times as far.
    """
    folder = shared_data / "motion"
    amc = _steps_m(read_capture_file(folder / "cmu_asfamc/02_01.amc").motion)
    c3d = _steps_m(read_capture_file(folder / "cmu_c3d/02_01.c3d").motion)
    bvh = _steps_m(read_capture_file(folder / "cmu_bvh/02_01.bvh").motion)
    assert len(amc) == len(c3d) == len(bvh) == 4
    assert c3d == pytest.approx(amc, abs=0.01)
    assert sum(bvh) / sum(amc) == pytest.approx(1.06312, abs=0.01)


def _steps_m(motion: RigMotion | MarkerMotion | BodyMotion) -> list[float]:
    if not isinstance(motion, RigMotion):
        motion = fit_skeleton(motion).motion
    joint_map = propose_joint_map(motion.rig).joint_map
    return [step.length_m for step in walk_figures(motion, legs_of(motion.rig, joint_map)).strides]


def test_knees_bend_as_knees_of_walkers_do(walk: tuple[RigMotion, JointMap]) -> None:
    """Knees of walkers bend by 50 to 85 degrees at most in the swing, and hardly ever backwards."""
    for leg in leg_angles(*walk):
        assert 50.0 < np.degrees(leg.knee_rad.max()) < 85.0
        assert np.degrees(leg.knee_rad.min()) > -2.0


def test_lifts_agree_on_the_papers_avatars(walk: tuple[RigMotion, JointMap]) -> None:
    """All three avatars lift each foot as often as the person, within 0.1 s of each other."""
    avatars = [
        (f"{stature_m}", _onto(walk, stature_m).motion, REFERENCE_JOINT_MAP)
        for stature_m in PAPER_STATURES_M
    ]
    figures = verify(*walk, avatars)
    assert figures.lifts_agree
    assert figures.largest_timing_difference_s is not None
    assert figures.largest_timing_difference_s < 0.1


@pytest.mark.parametrize("share", [None, 0.43, 0.57])
def test_locking_the_feet_removes_their_slide(
    walk: tuple[RigMotion, JointMap], share: float | None
) -> None:
    """Locking the feet reduces their slide from 0.09 to 0.22 m/s to less than 0.005 m/s.

    The hips are lowered by at most 4 % of a leg, and no joint's velocity changes from frame to
    frame by more than twice what it does in the capture.
    """
    locked = _onto(walk, 1.65, share, lock=True)
    assert locked.walks is not None
    assert locked.walks.locked is not None
    assert locked.walks.slide_before_m_s is not None
    assert locked.walks.slide_m_s is not None
    assert 0.08 < locked.walks.slide_before_m_s < 0.25
    assert locked.walks.slide_m_s < 0.005
    assert locked.walks.locked.lowered_m <= 0.04 * locked.walks.avatar.leg_length_m + 1e-12
    assert locked.walks.locked.out_of_reach < 0.02 * locked.motion.frame_count
    free = _onto(walk, 1.65, share)
    assert _largest_jerk_m_s(locked.motion) < 2.0 * _largest_jerk_m_s(free.motion)
