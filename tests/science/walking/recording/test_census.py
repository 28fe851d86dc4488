"""Tests of the census of path lengths: counts by interval, shares and the cutoff."""

import numpy as np
import pytest

from app.science.walking.recording.census import census
from app.science.walking.records.model import WalkingError


def test_lengths_are_counted_in_their_intervals() -> None:
    """A length on a bound counts in the interval above, and the shares add up to one."""
    counted = census([0.2, 0.5, 0.7, 1.4, 3.0], width_m=0.5)
    assert counted.counts == (1, 2, 1, 0, 0, 0, 1)
    assert counted.edges_m[:3] == (0.0, 0.5, 1.0)
    assert counted.share_up_to[1] == pytest.approx(0.6)
    assert counted.share_up_to[-1] == 1.0
    assert counted.quartiles_m[1] == pytest.approx(0.7)
    assert counted.total_m == pytest.approx(5.8)


def test_the_cutoff_is_what_five_percent_exceed() -> None:
    """Five of a hundred lengths exceed the cutoff."""
    lengths = np.arange(1, 101) / 10.0
    counted = census(lengths.tolist())
    assert int((lengths > counted.cutoff_m).sum()) == 5


@pytest.mark.parametrize("lengths", [[], [1.0, float("nan")], [0.0], [1e9]])
def test_invalid_lengths_are_rejected(lengths: list[float]) -> None:
    """No lengths, invalid lengths and one that would need millions of intervals are rejected."""
    with pytest.raises(WalkingError):
        census(lengths)
