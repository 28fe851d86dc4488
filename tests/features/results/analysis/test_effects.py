"""Tests of the size of effects, against values that were worked out by hand."""

import pandas as pd
import pytest

from app.features.results.analysis.questions.effects import effects_of
from app.features.results.analysis.questions.measures import Measure


def _measure(values: dict[str, dict[float, float]]) -> Measure:
    rows = [
        {"participant_code": code, "limb": "hand", "latency_ms": latency_ms, "value": value}
        for code, of in values.items()
        for latency_ms, value in of.items()
    ]
    table = pd.DataFrame(rows)
    return Measure("agency", "Agency", "points", "", table, table, continuous=False)


def test_an_effect_is_the_difference_of_the_ends_in_average_standard_deviations() -> None:
    """Four people fall by 3, 2, 4 and 1: -2.5 points, and d_av = -2.5 / ((0.8165 + 1.2910) / 2).

    The interval is -2.5 +- 3.1824 * 1.2910 / 2, with Student's t of three degrees of freedom.
    """
    ends = zip((5.0, 6.0, 7.0, 6.0), (2.0, 4.0, 3.0, 5.0), strict=True)
    values = {f"P-{at}": {0.0: a, 125.0: 9.0, 350.0: b} for at, (a, b) in enumerate(ends)}
    (effect,) = effects_of(_measure(values))
    assert (effect.contrast, effect.n, effect.difference) == ("350 ms − 0 ms", 4, -2.5)
    assert effect.standardised == pytest.approx(-2.3725, abs=1e-4)
    assert effect.low is not None
    assert effect.high is not None
    assert (effect.low, effect.high) == pytest.approx((-4.5543, -0.4457), abs=1e-4)
    assert effect.standardised_low == pytest.approx(effect.low / 1.05374, abs=1e-3)


def test_somebody_without_one_of_the_ends_is_left_out() -> None:
    """Of three people one has no value at the largest latency: the effect is that of two."""
    values = {"P-0": {0.0: 1.0, 350.0: 3.0}, "P-1": {0.0: 2.0, 350.0: 5.0}, "P-2": {0.0: 9.0}}
    (effect,) = effects_of(_measure(values))
    assert (effect.n, effect.difference) == (2, 2.5)
    assert not list(effects_of(_measure({"P-0": {0.0: 1.0, 350.0: 3.0}})))


def test_where_nothing_varies_the_effect_has_no_standardised_size() -> None:
    """If everybody answers alike, the difference is known and its size in deviations is not."""
    values = {f"P-{at}": {0.0: 7.0, 350.0: 2.0} for at in range(3)}
    (effect,) = effects_of(_measure(values))
    assert effect.difference == -5.0
    assert (effect.standardised, effect.standardised_low) == (None, None)
