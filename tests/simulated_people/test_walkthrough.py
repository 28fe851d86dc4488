"""Tests of walking a simulated participant through the first task of a phase."""

from dataclasses import replace

import pytest

from app.science.delay import LONGEST_DELAY_S, DelayError
from app.science.tasks import Laterality
from app.simulated_people.walkthrough import SLOW, walk_through
from tests.protocol.helpers import study


@pytest.mark.parametrize("stature_m", [1.518, 1.869])
def test_short_and_tall_people_reach_the_shipped_boxes(stature_m: float) -> None:
    """The 5th percentile of women and the 95th of men complete both tasks without latency."""
    for limb in ("hand", "foot"):
        done = walk_through(study().tasks.layout(limb), Laterality.RIGHT, stature_m, 0.0)
        assert done.out_of_reach == ()
        assert done.completion_s is not None


def test_latency_and_a_slow_pace_cost_time() -> None:
    """The first hand task takes longer with 350 ms than without, and longer for slow people."""
    layout = study().tasks.layout("hand")
    brisk = replace(SLOW, tempo=1.0)
    times = [
        walk_through(layout, Laterality.LEFT, 1.7, latency_s, traits).completion_s or 0.0
        for latency_s, traits in ((0.0, brisk), (0.35, brisk), (0.35, SLOW))
    ]
    assert times[0] + 4 * 0.35 < times[1] < times[2]


def test_a_latency_that_no_buffer_keeps_is_refused() -> None:
    """The avatar of a walk-through keeps as much movement as a headset's."""
    layout = study().tasks.layout("hand")
    with pytest.raises(DelayError, match=r"exceeds the 2\.0 s"):
        walk_through(layout, Laterality.LEFT, 1.7, LONGEST_DELAY_S + 0.1)
