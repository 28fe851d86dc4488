"""Tests of skewed movements, and of movements that somebody's recordings say."""

from dataclasses import dataclass, replace

import numpy as np
import pytest

from app.science.rotations import FloatArray
from app.science.simulation import MovementTraits, shortest_time_s, skewed_jerk
from app.science.simulation.aiming import Aim
from app.science.simulation.paths import minimum_jerk
from tests.science.simulation.people import rng_of
from tests.science.simulation.reaches import touch


@dataclass(frozen=True)
class AlwaysTheSame:
    """Somebody whose hands move in the same way every time."""

    lasts_s: float
    skew: float
    counts: tuple[int, int] = (0, 0)

    def movement(
        self, distance_m: float, near_m: float, rng: np.random.Generator
    ) -> tuple[float, float]:
        """Return the same movement."""
        del distance_m, near_m, rng
        return self.lasts_s, self.skew


def covered(skew: float) -> FloatArray:
    """Return the share of the way at 0, 1, ... 1000 thousandths of the time."""
    return np.array([skewed_jerk(at / 1000.0, skew) for at in range(1001)])


def test_a_movement_without_skew_is_the_minimum_jerk_to_the_last_bit() -> None:
    """With a skew of 1 every share is that of Flash and Hogan, without any rounding between."""
    assert covered(1.0).tolist() == [minimum_jerk(at / 1000.0) for at in range(1001)]


@pytest.mark.parametrize("skew", [0.6, 0.8, 1.3, 2.5])
def test_a_skewed_movement_starts_and_ends_at_rest_and_never_turns_back(skew: float) -> None:
    """Its way rises from 0 to 1, with hardly any speed at both ends."""
    way = covered(skew)
    assert (way[0], way[-1]) == (0.0, 1.0)
    assert (np.diff(way) > -1e-12).all()
    assert max(np.diff(way)[[0, -1]]) < 0.1 * np.diff(way).max()


def test_more_skew_puts_the_fastest_moment_earlier() -> None:
    """The greater the skew, the earlier the peak of speed; at 1 it is in the middle."""
    peaks = [int(np.argmax(np.diff(covered(skew)))) for skew in (0.5, 0.8, 1.0, 1.3, 2.5)]
    assert peaks == sorted(peaks, reverse=True)
    assert peaks[2] in (499, 500)


def test_a_path_takes_the_time_and_the_skew_that_recordings_say() -> None:
    """A learnt movement replaces the pace of the traits, and keeps its skew when it has to wait."""
    aim = Aim(MovementTraits(), 1.0, 0.0, AlwaysTheSame(0.9, 2.0))
    path = aim.path((0.0, 1.25, -0.45), (0.0, 0.0, 0.0), touch(0.4), 0.0, rng_of())
    assert path.end_s == pytest.approx(0.9)
    assert path.at(0.3)[0] == pytest.approx(0.4 * skewed_jerk(1.0 / 3.0, 2.0))
    assert path.waiting_to_enter(0, 0.5).skew == 2.0


def test_nobody_moves_faster_than_the_fastest() -> None:
    """A learnt time that nobody could keep is prolonged to the shortest time of the distance."""
    aim = Aim(MovementTraits(), 1.0, 0.0, AlwaysTheSame(0.01, 1.0))
    path = aim.path((0.0, 1.25, -0.45), (0.0, 0.0, 0.0), touch(0.4), 0.0, rng_of())
    assert path.end_s == pytest.approx(shortest_time_s(0.4))


def test_feet_keep_the_pace_of_the_traits() -> None:
    """Without what was learnt of hands, a path is that of the traits."""
    traits = MovementTraits(reaching=AlwaysTheSame(9.0, 2.0))
    here, way = (0.0, 1.25, -0.45), (0.0, 0.0, 0.0)
    foot = Aim(traits, 1.4, 0.0).path(here, way, touch(0.4), 0.0, rng_of())
    assumed = replace(traits, reaching=None)
    assert foot == Aim(assumed, 1.4, 0.0).path(here, way, touch(0.4), 0.0, rng_of())
