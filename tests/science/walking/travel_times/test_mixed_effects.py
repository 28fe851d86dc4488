"""Tests of travel times with effects of people: Student's t, few people, known answers."""

from pathlib import Path

import numpy as np
import pytest
from scipy import stats

from app.science.rotations import FloatArray
from app.science.walking.models import covers, crps_s
from app.science.walking.records import WalkingError
from app.science.walking.travel_times import (
    ConstantSpeed,
    Line,
    StartingAndStopping,
    TimedWalks,
    posterior_of,
)
from tests.benchmarks.walking_people import preferred_speeds
from tests.science.walking.travel_times.test_curves import walks


def timed(lengths: FloatArray, durations_s: FloatArray, subjects: list[str]) -> TimedWalks:
    """Return straight walks from rest to rest."""
    count = len(lengths)
    return TimedWalks(
        lengths, np.zeros(count), np.ones(count), np.empty((count, 0)), durations_s, tuple(subjects)
    )


def made_up(
    people: int, rng: np.random.Generator, repetitions: int = 2
) -> tuple[TimedWalks, FloatArray]:
    """Return walks of people with known pace and ramp, and log pace and ramp of each person."""
    own = np.array([np.log(0.75), np.log(1.4)]) + rng.standard_normal((people, 2)) * [0.1, 0.15]
    lengths = np.tile([1.0, 2.0, 4.0, 8.0], repetitions)
    rows, names = [], []
    for at, values in enumerate(own):
        median_s = StartingAndStopping().times_s(walks(lengths), np.append(values, [0.0, 1.0]))
        rows.append(median_s * np.exp(0.04 * rng.standard_normal(len(lengths))))
        names += [f"{at:03}"] * len(lengths)
    return timed(np.tile(lengths, people), np.concatenate(rows), names), own


@pytest.mark.parametrize("people", [4, 12])
def test_one_walk_of_each_is_predicted_by_students_t(people: int) -> None:
    """With one walk each on one path, intervals are those of Student's t for so few people."""
    rng = np.random.default_rng(3)
    logs = np.log(4.0) + stats.norm.ppf((np.arange(people) + 0.5) / people) * 0.12
    data = timed(np.full(people, 3.0), np.exp(logs), [str(at) for at in range(people)])
    drawn, _, _ = posterior_of(data, ConstantSpeed(), rng).draw(walks(np.array([3.0])), 20000, rng)
    half = logs.std(ddof=1) * np.sqrt(1.0 + 1.0 / people)
    for level in (0.5, 0.9):
        expected = half * stats.t.ppf((1.0 + level) / 2.0, people - 1)
        low, high = np.quantile(np.log(drawn), [(1.0 - level) / 2.0, (1.0 + level) / 2.0])
        assert (high - low) / 2.0 == pytest.approx(expected, rel=0.2)


def test_many_walks_of_few_people_are_still_few_people() -> None:
    """Recording four people ten times as often does not make the prediction for a fifth narrow."""
    rng = np.random.default_rng(5)
    paces = np.exp(np.log(0.75) + 0.15 * np.array([-1.0, -0.3, 0.3, 1.0]))
    widths = []
    for repetitions in (3, 30):
        lengths = np.full(4 * repetitions, 6.0)
        noise = np.exp(0.01 * rng.standard_normal(len(lengths)))
        names = [f"{at}" for at in range(4) for _ in range(repetitions)]
        data = timed(lengths, np.repeat(paces, repetitions) * lengths * noise, names)
        drawn, _, _ = posterior_of(data, ConstantSpeed(), rng).draw(
            walks(np.array([6.0])), 5000, rng
        )
        low, high = np.quantile(np.log(drawn), [0.05, 0.95])
        widths.append(high - low)
    assert widths[1] == pytest.approx(widths[0], rel=0.25)
    assert widths[1] > 2.0 * 1.645 * paces.std(ddof=1) / paces.mean()


def test_known_people_are_found() -> None:
    """Pace, ramp and their spread between people are found from walks with known answers."""
    data, own = made_up(30, np.random.default_rng(1))
    found = posterior_of(data, StartingAndStopping(), np.random.default_rng(2))
    off = found.coefficients[:, :2].mean(axis=0) - own.mean(axis=0)
    assert np.all(np.abs(off) < 3.0 * found.coefficients[:, :2].std(axis=0))
    between = np.sqrt(np.median(found.between, axis=0).diagonal())
    np.testing.assert_allclose(between, own.std(axis=0, ddof=1), rtol=0.3)


def test_few_people_give_wide_intervals_that_hold() -> None:
    """Learnt from three people, the 50 and 90 % intervals contain so many walks of others."""
    rng = np.random.default_rng(7)
    inside = []
    for _ in range(30):
        data, _ = made_up(3, rng, repetitions=1)
        others, _ = made_up(6, rng, repetitions=1)
        found = posterior_of(data, StartingAndStopping(), rng)
        for at in range(0, len(others), 4):
            drawn, _, _ = found.draw(others.select(np.array([at + 3])), 400, rng)
            truth = float(others.durations_s[at + 3])
            inside.append([covers(drawn, truth, share) for share in (0.5, 0.9)])
    half, most = np.mean(inside, axis=0)
    assert 0.4 < half < 0.65
    assert 0.83 < most < 0.98


def test_one_odd_walk_does_not_widen_all() -> None:
    """One walk that took three times as long is a heavy tail, not a wider spread of all walks."""
    data, _ = made_up(8, np.random.default_rng(1))
    odd_s = data.durations_s.copy()
    odd_s[5] *= 3.0
    widths = []
    for durations_s in (data.durations_s, odd_s):
        found = posterior_of(timed(data.lengths_m, durations_s, list(data.subjects)),
                             StartingAndStopping(), np.random.default_rng(2))  # fmt: skip
        drawn, _, _ = found.draw(walks(np.array([4.0])), 4000, np.random.default_rng(3))
        widths.append(np.ptp(np.quantile(drawn, [0.25, 0.75])))
    assert widths[1] < 1.5 * widths[0]


def test_the_seed_decides_and_one_person_is_refused() -> None:
    """The same seed learns the same; nothing is learnt from a single person."""
    data, _ = made_up(3, np.random.default_rng(1))
    first, second = (posterior_of(data, Line(), np.random.default_rng(4)) for _ in range(2))
    np.testing.assert_array_equal(first.coefficients, second.coefficients)
    with pytest.raises(WalkingError, match="walks are of one person, '000'"):
        posterior_of(data.select(np.arange(8)), Line(), np.random.default_rng(4))


def test_real_people_on_half_a_metre_to_89_metres(shared_data: Path) -> None:
    """Seethapathi's three people (2015), left out in turn: constant speed errs twice as much."""
    data = preferred_speeds(shared_data).walks
    subjects = np.array(data.subjects)
    errors = []
    for curve in (StartingAndStopping(), ConstantSpeed()):
        rng, scores = np.random.default_rng(1), []
        for person in data.persons:
            found = posterior_of(data.select(subjects != person), curve, rng)
            for at in np.flatnonzero(subjects == person):
                drawn, _, _ = found.draw(data.select(np.array([at])), 300, rng)
                scores.append(crps_s(drawn, float(data.durations_s[at])))
        errors.append(np.mean(scores))
    assert errors[0] < 0.5 * errors[1]
