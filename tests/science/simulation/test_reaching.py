"""Tests of how a simulated hand moves to its goal, and of what late vision does to it."""

import numpy as np
import pytest

from app.science.simulation import MovementTraits
from app.science.simulation.aiming import Aim
from app.science.simulation.paths import path_through
from app.science.simulation.vision import LateVision
from tests.science.simulation.people import RATE_HZ, person_of, rng_of, tip
from tests.science.simulation.reaches import (
    NOISY,
    fitts_slope_s_per_bit,
    reach_of,
    reached,
    touch,
)


def test_a_reach_is_straight_and_its_speed_has_one_peak_in_the_middle() -> None:
    """The path is nearly straight, and the speed a bell with a peak of 1.875 times its mean.

    Flash and Hogan 1985: a minimum-jerk movement peaks in the middle, at 15/8 of the mean speed.
    """
    reaches = [reach_of(seed) for seed in range(8)]
    for one in reaches:
        speed, peak, most = one.speed_m_s, one.peak, one.speed_m_s.max()
        # Up to the peak and down again, apart from corrections, which are slow.
        assert np.count_nonzero(speed > 0.5 * most) > 5
        rising, falling = speed[: peak + 1], speed[peak : 2 * peak]
        assert (np.diff(rising) > -0.05 * most).all()
        assert (np.diff(falling) < 0.05 * most).all()
    # A minimum-jerk speed is above half its peak for 0.541 of the time.
    assert np.median([one.half_share for one in reaches]) == pytest.approx(0.541, abs=0.08)
    assert np.median([one.peak_share for one in reaches]) == pytest.approx(0.5, abs=0.08)
    # Straight reaches of people deviate by some per cent: Atkeson and Hollerbach 1985.
    assert np.median([one.deviation for one in reaches]) < 0.05


def test_the_time_to_hit_follows_fitts_law_within_published_slopes() -> None:
    """The time from setting off until the tip stays in the target rises by .10 to .27 s per bit.

    Fitts 1954 found 10.1 bit/s in tapping; Soukoreff and MacKenzie 2004 list 3.7 to 4.9 bit/s for
    the mouse. The participant chooses its pace; noise and corrections are not told of it.
    """
    assert 0.10 <= fitts_slope_s_per_bit() <= 0.27


@pytest.mark.parametrize(("late_s", "most_m"), [(0.0, 0.002), (0.35, 0.3)])
def test_a_late_picture_of_the_hand_makes_it_overshoot(late_s: float, most_m: float) -> None:
    """Somebody who moves exactly stays on target by present sight, and overshoots by late sight."""
    person = person_of(traits=MovementTraits(precision=0.0, patience_s=60.0))
    reached(person, touch(-0.2), 0.0, 3.0, late_s)
    way = reached(person, touch(0.2), 3.0, 3.0, late_s)
    beyond_m = float(way[:, 0].max()) - 0.2
    assert beyond_m < most_m
    assert late_s == 0.0 or beyond_m > 0.03


def test_sight_corrects_the_noise_of_a_movement() -> None:
    """With sight the hand ends less than half as far from its goal as without."""
    ends_m: dict[bool, list[float]] = {True: [], False: []}
    for seeing, distances in ends_m.items():
        for seed in range(8):
            person = person_of(seed, NOISY)
            goal, frames = touch(0.2), range(round(4.0 * RATE_HZ))
            for frame in frames:
                place = tip(person.pose(frame / RATE_HZ, goal), "Right")
                if seeing:
                    x, y, z = place.tolist()
                    person.see(frame / RATE_HZ, "RightHand", (x, y, z))
            distances.append(float(np.linalg.norm(place - np.array(goal.target_m))))
    assert np.mean(ends_m[True]) < 0.5 * np.mean(ends_m[False])


def test_the_correction_loop_grows_only_beyond_its_limit_of_stability() -> None:
    """A correction by a picture late by D decays for g D below pi/2, and grows above it.

    The delay equation dc/dt = -g (n + c(t - D)) is stable exactly for g D < pi/2 (Hayes 1950).
    """
    for product, decays in ((1.4, True), (1.75, False)):
        vision, step_s, late_s = LateVision(0.1), 0.001, 0.9
        gain = product / (late_s + 0.1)
        held = [(0.0, 0.0, 0.0)] * round(late_s / step_s)
        swings = []
        for frame in range(20_000):
            t_s = frame * step_s
            x = 0.01 + vision.correction_m[0]
            held.append((x, 0.0, 0.0))
            vision.see(t_s, held.pop(0))
            vision.perceive(t_s)
            vision.correct(t_s, (0.0, 0.0, 0.0), (gain, 0.0), step_s)
            swings.append(abs(x))
        assert (max(swings[-5000:]) < max(swings[5000:10_000])) is decays


def test_noise_grows_with_the_speed_of_a_movement() -> None:
    """The end of a movement scatters in proportion to its mean speed, half as widely across."""
    rng = rng_of()
    aim = Aim(MovementTraits(), 1.0, 0.0)
    for lasts_s in (0.4, 0.8):
        path = path_through([(0.0, 0.0, 0.0), (0.4, 0.0, 0.0)], 0.0, lasts_s)
        ends = np.array([aim.noise(path, rng).at(9.0) for _ in range(4000)])
        along = 0.012 * 0.4 / lasts_s
        assert ends.std(axis=0) == pytest.approx([along, along / 2, along / 2], rel=0.05)
