"""Which Motive bone hangs on which, where the file does not say."""

import numpy as np
import pytest

from app.adapters.captures import CaptureError, Limits, read_capture
from app.adapters.captures.motive.hierarchy import parents_first
from app.science.rig import RigMotion
from tests.adapters.captures.motive_texts import Dialect, motive_text
from tests.adapters.captures.moving_rigs import some_motion, some_rig


def test_names_as_in_fbx_are_known() -> None:
    """An export with FBX names before 1.25 keeps its skeleton."""
    trunk = ("Hips", "Spine", "Spine1", "Neck", "Head")
    arm = ("LeftShoulder", "LeftArm", "LeftForeArm", "LeftHand")
    names = (*trunk, *arm, "LeftUpLeg", "LeftLeg", "LeftFoot", "LeftToeBase")
    parents = (-1, 0, 1, 2, 3, 2, 5, 6, 7, 0, 9, 10, 11)
    rng = np.random.default_rng(41)
    motion = some_motion(rng, some_rig(rng, names, parents))
    found = read_capture(motive_text(motion, Dialect()).encode(), name="take.csv").motion
    assert isinstance(found, RigMotion)
    assert found.rig.parents == parents
    np.testing.assert_allclose(found.world()[0], motion.world()[0], atol=1e-6)


def test_children_may_stand_before_their_parents() -> None:
    """The order of columns says nothing: parents come first in the rig."""
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
def test_what_is_no_tree_is_refused(parents: list[int], reason: str) -> None:
    """Two roots, none, circles and endless chains have no skeleton."""
    with pytest.raises(CaptureError, match=reason):
        parents_first(parents, ["a", "b", "c", "d"][: len(parents)], Limits(depth=3))
