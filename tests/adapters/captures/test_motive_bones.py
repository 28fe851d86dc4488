"""Tests of the hierarchy of Motive's bones in files that do not state it."""

import numpy as np
import pytest

from app.adapters.captures import CaptureError, Limits, read_capture
from app.adapters.captures.motive.hierarchy import parents_first
from app.science.rig import RigMotion
from tests.adapters.captures.motive_texts import Dialect, motive_text
from tests.adapters.captures.moving_rigs import random_motion, random_rig


def test_fbx_names_are_recognised() -> None:
    """An export with FBX names before 1.25 is read as a skeleton."""
    trunk = ("Hips", "Spine", "Spine1", "Neck", "Head")
    arm = ("LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand")
    names = (*trunk, *arm, "LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToeBase")
    parents = (-1, 0, 1, 2, 3, 2, 5, 6, 7, 0, 9, 10, 11)
    rng = np.random.default_rng(41)
    motion = random_motion(rng, random_rig(rng, names, parents))
    found = read_capture(motive_text(motion, Dialect()).encode(), name="take.csv").motion
    assert isinstance(found, RigMotion)
    assert found.rig.parents == parents
    np.testing.assert_allclose(found.world()[0], motion.world()[0], atol=1e-6)


def test_children_may_be_listed_before_their_parents() -> None:
    """Parents come first in the rig, whatever the order of columns."""
    order = parents_first([2, 0, -1, 0], ["a", "b", "root", "c"], Limits())
    assert order == [2, 0, 1, 3]


@pytest.mark.parametrize(
    ("parents", "reason"),
    [
        ([-1, -1], "has one root bone, this one has: a, b"),
        ([1, 0], "this one has: none"),
        ([-1, 2, 1], "the parents of bone b form a circle"),
        ([-1, 0, 1, 2], "nested deeper than 3"),
    ],
)
def test_bones_that_form_no_tree_are_rejected(parents: list[int], reason: str) -> None:
    """Bones that have two roots or none, or form a circle or an endless chain, are rejected."""
    with pytest.raises(CaptureError, match=reason):
        parents_first(parents, ["a", "b", "c", "d"][: len(parents)], Limits(depth=3))
