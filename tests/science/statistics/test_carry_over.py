"""Tests of effects of order, sequence and carry-over in a Williams design."""

import numpy as np
import pytest

from app.science.statistics.mixed.carry_over import CarryOver, carry_over
from app.science.statistics.mixed.terms import ModelError, factor
from app.science.williams import williams

LEVELS = ("0", "125", "350")
EFFECT = {"0": 0.0, "125": -1.0, "350": -3.0}


class Experiment:
    """An experiment with all orders of three latencies `repeats` times and two limbs per period."""

    def __init__(self, repeats: int = 2) -> None:
        """Create the rows of the design."""
        orders = [tuple(LEVELS[at] for at in row) for row in williams(3)] * repeats
        self.rows = [
            (who, order, period, limb)
            for who, order in enumerate(orders)
            for period in range(3)
            for limb in ("hand", "foot")
        ]
        self.people = [who for who, _, _, _ in self.rows]
        self.conditions = [order[period] for _, order, period, _ in self.rows]
        self.periods = [period + 1 for _, _, period, _ in self.rows]
        self.limbs = [limb for _, _, _, limb in self.rows]

    def values(self, left_behind: dict[str, float], practice: float, noise: float) -> np.ndarray:
        """Return values with effects of latency and practice, and carry-over between periods."""
        rng = np.random.default_rng(23)
        level = rng.normal(size=max(self.people) + 1)
        exact = [
            EFFECT[order[at]]
            + practice * at
            + (left_behind[order[at - 1]] if at else 0.0)
            + level[who]
            for who, order, at, _ in self.rows
        ]
        return np.array(exact) + noise * rng.normal(size=len(exact))

    def diagnose(self, values: np.ndarray) -> CarryOver:
        """Return the carry-over analysis with the limb as a further factor."""
        return carry_over(
            values,
            self.people,
            self.conditions,
            self.periods,
            further=[factor("limb", self.limbs)],
        )


def codes(found: CarryOver) -> list[str]:
    """Return the codes of the conclusions."""
    return [one.code for one in found.conclusions]


def test_carry_over_is_found_and_measured() -> None:
    """Simulated differences in carry-over between conditions are recovered."""
    experiment = Experiment()
    values = experiment.values({"0": 0.0, "125": 0.5, "350": 2.0}, 0.0, 0.05)
    found = experiment.diagnose(values)
    true = {("0", "125"): -0.5, ("0", "350"): -2.0, ("125", "350"): -1.5}
    for one in found.differences:
        assert one.value.estimate == pytest.approx(true[one.a, one.b], abs=0.08)
        assert one.value.low < true[one.a, one.b] < one.value.high
    assert found.carry_over.p < 1e-9
    assert codes(found)[0] == "carry_over_shown"
    assert found.carry_over.df_term == 2


def test_equal_carry_over_of_all_conditions_looks_like_period() -> None:
    """Equal carry-over after all conditions is reported as confounded with practice."""
    experiment = Experiment()
    found = experiment.diagnose(experiment.values(dict.fromkeys(LEVELS, 2.0), 0.0, 0.3))
    assert found.period.p < 1e-6
    assert found.carry_over.p > 0.05
    assert codes(found)[:2] == ["carry_over_not_shown", "period_shown"]
    assert codes(found)[-1] == "limits"


def test_absence_of_carry_over_is_reported_with_a_bound() -> None:
    """Without carry-over the result names the largest one compatible with the data."""
    experiment = Experiment()
    found = experiment.diagnose(experiment.values(dict.fromkeys(LEVELS, 0.0), 0.0, 1.0))
    widest = max(max(-one.value.low, one.value.high) for one in found.differences)
    assert found.largest_possible == pytest.approx(widest)
    assert found.largest_possible > 0.5
    assert f"{found.largest_possible:.3g}" in found.conclusions[0].text


def test_the_complete_design_is_balanced() -> None:
    """Each latency occurs four times at each position and after each other latency."""
    experiment = Experiment()
    orders = experiment.diagnose(experiment.values(dict.fromkeys(LEVELS, 0.0), 0.1, 1.0)).orders
    assert orders.balanced
    assert dict(orders.positions) == dict.fromkeys(LEVELS, (4, 4, 4))
    assert {count for _, count in orders.neighbours} == {4}
    assert [count for _, count in orders.counts] == [2] * 6
    assert orders.missing == ()


def test_the_sequence_is_tested_between_participants() -> None:
    """Twelve people in six orders leave 6 error df; one person per order leaves none."""
    experiment, single = Experiment(), Experiment(1)
    sequence = experiment.diagnose(experiment.values(dict.fromkeys(LEVELS, 0.0), 0.1, 0.5)).sequence
    assert sequence is not None
    assert (sequence.df_term, round(sequence.df_error, 6)) == (5, 6)
    alone = single.diagnose(single.values(dict.fromkeys(LEVELS, 0.0), 0.1, 0.5))
    assert alone.sequence is None
    assert "sequence_untested" in codes(alone)


def test_a_missing_order_is_named() -> None:
    """Without the participants of one order the design is unbalanced and names that order."""
    experiment = Experiment()
    values = experiment.values(dict.fromkeys(LEVELS, 0.0), 0.1, 0.5)
    remaining = [at for at, row in enumerate(experiment.rows) if row[1] != LEVELS]
    found = carry_over(
        values[remaining],
        [experiment.people[at] for at in remaining],
        [experiment.conditions[at] for at in remaining],
        [experiment.periods[at] for at in remaining],
    )
    assert found.orders.missing == (LEVELS,)
    assert not found.orders.balanced
    assert "unbalanced" in codes(found)


def test_an_unknown_condition_before_is_left_out_and_counted() -> None:
    """A period after a missing one has no known previous condition, is left out and is counted."""
    experiment = Experiment()
    values = experiment.values(dict.fromkeys(LEVELS, 0.0), 0.1, 0.5)
    remaining = [at for at, row in enumerate(experiment.rows) if (row[0], row[2]) != (4, 1)]
    found = carry_over(
        values[remaining],
        [experiment.people[at] for at in remaining],
        [experiment.conditions[at] for at in remaining],
        [experiment.periods[at] for at in remaining],
    )
    assert found.left_out == 2
    assert found.orders.incomplete == 1


def test_a_period_has_one_condition() -> None:
    """Two conditions in one period of a participant are rejected by name."""
    with pytest.raises(ModelError, match="Participant 1 has the conditions a and b in period 1"):
        carry_over([1.0, 2.0, 3.0], [1, 1, 1], ["a", "b", "a"], [1, 1, 2])
