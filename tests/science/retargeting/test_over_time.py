"""Tests that captures are checked over time: frames that repeat, jumps, exchanged labels, legs."""

from dataclasses import replace

import numpy as np
import pytest

from app.science.anatomy import frozen_notice, jump_notice, repeated
from app.science.fitting import fit_skeleton
from app.science.retargeting.anatomy_checks import checked_skeleton, knee_notice, one_sided_notice
from app.science.rig import RigMotion
from tests.science.fitting.synthetic_body import markers_on, moving
from tests.science.retargeting.bodies import SAME, own_body
from tests.science.retargeting.walks import made_walk


def _walk() -> RigMotion:
    """Return a made walk with the noise of a measured one."""
    walk = made_walk(own_body(1.75)).motion
    rng = np.random.default_rng(0)
    return replace(
        walk,
        root_positions_m=walk.root_positions_m + rng.normal(0.0, 1e-6, walk.root_positions_m.shape),
        rotations=walk.rotations + rng.normal(0.0, 1e-9, walk.rotations.shape),
    )


def _rules(motion: RigMotion) -> list[str]:
    return [notice.rule for notice in checked_skeleton(motion, SAME)[1]]


def _held(motion: RigMotion, first: int, last: int) -> RigMotion:
    """Return a movement whose pose repeats that of `first` up to `last`, from 0."""
    rotations = motion.rotations.copy()
    rotations[first : last + 1] = rotations[first]
    return replace(motion, rotations=rotations)


def test_frames_that_repeat_for_more_than_half_a_second_are_noted() -> None:
    """A held frame is named with its frames; half a second, and a pose all along, are not."""
    motion = _walk()
    half = round(0.5 * motion.rate_hz)
    assert _rules(motion) == []
    assert _rules(_held(motion, 20, 20 + half)) == []
    (notice,) = checked_skeleton(_held(motion, 20, 21 + half), SAME)[1]
    assert (notice.rule, notice.action) == ("frozen", "noted")
    assert f"frames 21 to {22 + half} are alike" in notice.value
    assert _rules(_held(motion, 0, motion.frame_count - 1)) == []
    assert _rules(_held(motion, 0, 20 + half)) == []
    markers = markers_on(moving(0))
    places = markers.positions_m.copy()
    places[80 : 82 + half] = places[80]
    told = fit_skeleton(replace(markers, positions_m=places)).notices
    assert [one.rule for one in told] == ["frozen"]


def test_what_was_not_seen_does_not_repeat() -> None:
    """Frames without any value are gaps; a lost marker beside held ones does not hide these."""
    places = np.arange(12.0).reshape(6, 2)
    places[1:4] = np.nan
    assert not repeated(places).any()
    places[:, 0] = 7.0
    assert repeated(places).tolist() == [False, True, True, False, False]
    assert frozen_notice({"it": repeated(places)}, rate_hz=5.0) is None
    notice = frozen_notice({"it": repeated(places)}, rate_hz=3.0)
    assert notice is not None
    assert "frames 2 to 4" in notice.value


def test_a_root_that_jumps_is_noted_with_its_frames() -> None:
    """Half a metre within a frame is a jump there and back; a sprint is none."""
    motion = _walk()
    root = motion.root_positions_m.copy()
    root[50:60] += 0.5
    (notice,) = checked_skeleton(replace(motion, root_positions_m=root), SAME)[1]
    assert (notice.rule, notice.action) == ("jump", "noted")
    assert "the jumps lead to frame 51, 61" in notice.value
    sprint = np.outer(np.arange(20.0), (0.1, 0.0, 0.0))
    assert jump_notice(sprint, 120.0) is None
    assert jump_notice(sprint, 130.0) is not None


def test_labels_that_are_exchanged_for_part_of_the_time_are_noted() -> None:
    """Ankles exchanged in 20 of 200 frames are named with these frames, and fitted as they are."""
    markers = markers_on(moving(0))
    assert fit_skeleton(markers).notices == ()
    at = [markers.names.index(name) for name in ("LANK", "RANK")]
    places = markers.positions_m.copy()
    places[60:80, at] = places[60:80, at[::-1]]
    found = fit_skeleton(replace(markers, positions_m=places)).notices
    notice = next(one for one in found if one.rule == "jump")
    assert notice.action == "noted"
    assert "LKNE and LANK" in notice.value
    assert "in 20 frames, from 61 to 80" in notice.value


@pytest.mark.parametrize(
    ("change", "words"),
    [("backwards", "One knee bends backwards"), ("stiff", "One knee never moves")],
)
def test_a_knee_that_bends_backwards_or_never_is_noted(change: str, words: str) -> None:
    """In a walk, a knee whose angle is negated or left out is named; the walk itself is not."""
    walk = made_walk(own_body(1.75)).motion
    assert knee_notice(walk, SAME) is None
    knee = walk.rig.index(SAME["LeftLowerLeg"])
    rotations = walk.rotations.copy()
    rotations[:, knee] *= (1.0, -1.0, -1.0, -1.0)
    if change == "stiff":
        rotations[:, knee] = (1.0, 0.0, 0.0, 0.0)
    notice = knee_notice(replace(walk, rotations=rotations), SAME)
    assert notice is not None
    assert notice.what.startswith(words)
    assert "left" in notice.value


def test_strides_of_one_leg_alone_are_noted() -> None:
    """Between two strides of one leg there is one of the other: none is no walk, 1 and 0 may be."""
    for left, right, rules in ((0, 2, 1), (3, 0, 1), (1, 0, 0), (0, 0, 0), (1, 2, 0)):
        assert (one_sided_notice(left, right) is not None) == bool(rules)
