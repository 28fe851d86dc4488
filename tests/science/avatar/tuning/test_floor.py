"""Tests of how closely the avatar follows captured walks on a floor."""

from pathlib import Path

import pytest

from app.science.avatar.mjcf import FLOOR_ONLY, default_configuration
from app.science.avatar.tuning import track
from tests.science.avatar.captured import STATURE_M, captured, travelling

pytestmark = pytest.mark.thorough

SIX_WALKS = (
    "cmu_bvh/02_01.bvh", "cmu_bvh/05_06.bvh", "cmu_bvh/06_01.bvh", "cmu_bvh/12_02.bvh",
    "bvh_toolbox/walk01.bvh", "c3d/Gait.c3d",
)  # fmt: skip


@pytest.mark.parametrize("name", SIX_WALKS)
def test_a_floor_adds_at_most_a_degree_to_a_walk(shared_data: Path, name: str) -> None:
    """On a floor, a walk in place or travelling is followed at most 1 deg worse on average."""
    for read in (captured, travelling):
        walk = read(shared_data, name)
        alone = track(default_configuration(), STATURE_M, walk)
        on_floor = track(default_configuration(), STATURE_M, walk, scene=FLOOR_ONLY)
        assert on_floor.clamped.mean_deg - alone.clamped.mean_deg <= 1.0
        assert on_floor.clamped.p95_deg <= 7.0
