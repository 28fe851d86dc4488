"""Tests of the band of all lines between bounds: polygon algorithm against general solver."""

import numpy as np
import pytest
from scipy.optimize import linprog

from app.science.clock.band import Band, band_of
from app.science.clock.probes import Bounds

DRIFT = 500e-6


def _bounds(rng: np.random.Generator, count: int, width_s: float) -> Bounds:
    t_s = np.sort(rng.uniform(0.0, 200.0, count))
    offset_s = 3.0 + 80e-6 * t_s
    return Bounds(
        upper_t_s=t_s,
        upper_s=offset_s + rng.exponential(width_s, count),
        lower_t_s=t_s + 0.01,
        lower_s=offset_s - rng.exponential(width_s, count),
    )


def _solved(bounds: Bounds, t_s: float, sign: float) -> float | None:
    """Return the smallest (sign 1) or largest (-1) value at a time, by linear programming."""
    rows = [[1.0, t] for t in bounds.upper_t_s] + [[-1.0, -t] for t in bounds.lower_t_s]
    limits = [*bounds.upper_s, *(-bounds.lower_s)]
    found = linprog(
        [sign, sign * t_s], A_ub=rows, b_ub=limits, bounds=[(None, None), (-DRIFT, DRIFT)]
    )
    return None if found.fun is None else sign * float(found.fun)


@pytest.mark.parametrize("seed", range(12))
def test_the_extremes_are_those_of_linear_programming(seed: int) -> None:
    """The band's extremes equal those of linear programming, also outside of the bounds."""
    rng = np.random.default_rng(seed)
    bounds = _bounds(rng, int(rng.integers(1, 60)), 0.005)
    band = band_of(bounds, DRIFT)
    assert band is not None
    times_s = np.array([-50.0, 0.0, 77.7, 200.0, 900.0])
    low, high = band.at(times_s)
    for at, t_s in enumerate(times_s):
        assert low[at] == pytest.approx(_solved(bounds, t_s, 1.0), abs=1e-7)
        assert high[at] == pytest.approx(_solved(bounds, t_s, -1.0), abs=1e-7)


@pytest.mark.parametrize("seed", range(12))
def test_there_is_a_band_just_where_the_solver_finds_a_line(seed: int) -> None:
    """A band exists exactly where the solver finds a line, for bounds that nearly cross."""
    rng = np.random.default_rng(seed)
    loose = _bounds(rng, 8, 0.005)
    inwards_s = rng.uniform(0.0, 0.002)
    tight = Bounds(
        loose.upper_t_s, loose.upper_s - inwards_s, loose.lower_t_s, loose.lower_s + inwards_s
    )
    assert (band_of(tight, DRIFT) is None) == (_solved(tight, 0.0, 1.0) is None)


def test_more_bounds_never_allow_more_lines() -> None:
    """The band of the first k bounds never widens as k grows."""
    bounds = _bounds(np.random.default_rng(3), 40, 0.004)
    at = np.array([0.0, 100.0, 300.0])
    low, high = np.full(3, -np.inf), np.full(3, np.inf)
    for count in range(1, 41):
        band = band_of(bounds.between(0, count), DRIFT)
        assert band is not None
        next_low, next_high = band.at(at)
        assert (next_low >= low - 1e-9).all()
        assert (next_high <= high + 1e-9).all()
        low, high = next_low, next_high


def test_a_line_outside_is_brought_to_the_edge() -> None:
    """A line outside of the band is moved to its edge: first its slope, then its height."""
    band = band_of(_bounds(np.random.default_rng(4), 30, 0.003), DRIFT)
    assert isinstance(band, Band)
    a_s, slope = band.nearest(9.0, 1.0)
    assert slope == band.slopes[-1]
    assert a_s == band.high_s[-1]
    inside = (0.5 * (band.low_s[1] + band.high_s[1]), band.slopes[1])
    assert band.nearest(*inside) == pytest.approx(inside)
