"""Tests of raising a body smoothly where its feet would be under the floor."""

from pathlib import Path

import numpy as np
import pytest

from app.science.retargeting import reference_avatar
from app.science.rig import to_world
from app.science.skeleton import build_skeleton, clearance_m, sole_height
from tests.science.avatar.captured import STATURE_M, travelling

RATE_HZ = 100.0


@pytest.mark.parametrize("seed", range(5))
def test_the_lowest_point_ends_above_the_allowed_depth(seed: int) -> None:
    """Whatever the heights, no frame ends below the allowed depth, and none is raised for less."""
    lowest = np.random.default_rng(seed).normal(0.0, 0.03, 300)
    raised = clearance_m(lowest, RATE_HZ, allowed_m=0.005)
    assert (lowest + raised).min() >= -0.005 - 1e-12
    assert raised.min() >= 0.0
    assert raised.max() <= -0.005 - lowest.min() + 1e-12


def test_a_body_that_never_sinks_is_not_moved() -> None:
    """Heights above the allowed depth give no correction at all."""
    lowest = np.linspace(-0.004, 0.1, 50)
    assert not clearance_m(lowest, RATE_HZ, allowed_m=0.005).any()


def test_a_body_rises_smoothly() -> None:
    """A sudden sink of 5 cm raises the body over a tenth of a second, not from frame to frame."""
    lowest = np.where(np.arange(200) == 100, -0.05, 0.1)
    raised = clearance_m(lowest, RATE_HZ)
    assert raised[100] == pytest.approx(0.05)
    assert np.abs(np.diff(raised)).max() < 0.05 / 7.0


@pytest.mark.parametrize(
    "name", ["cmu_bvh/05_06.bvh", "cmu_bvh/12_02.bvh", "c3d/Gait.c3d", "bvh_toolbox/walk01.bvh"]
)
def test_the_soles_of_a_captured_walk_stay_on_the_floor(shared_data: Path, name: str) -> None:
    """Travelling, no corner of a sole sinks by a millimetre, and the lowest does not float."""
    walk = travelling(shared_data, name)
    _, world = to_world(reference_avatar(STATURE_M), walk.root_positions_m, walk.rotations)
    height = sole_height(world, build_skeleton(STATURE_M), walk.root_positions_m)
    assert -0.001 < height.min() < 0.02
