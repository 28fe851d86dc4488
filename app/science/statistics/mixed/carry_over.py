"""Diagnose order, sequence and carry-over: did the position or predecessor of a condition matter?

In a Williams design every condition is equally often at every position and follows every other
equally often. Then differences between positions (practice, fatigue) and a *first-order carry-over*
(the after-effect of the previous condition) can be separated from the effect of the condition
itself. Both are estimated in one linear mixed model of a measure,

    y = condition + period + carry-over + ... + participant + error,

carry-over being the deviation that each previous condition causes from the mean of all; the first
period has none. A second model tests the *sequence*, which is the order that a participant had. It
varies between participants only, so it has their number of degrees of freedom and little power; and
it includes the interaction of condition and period as well.

These are diagnostics. They cannot justify a choice of analysis: a test with a dozen participants
misses carry-over as large as the effect itself, and analysing only the first period because this
test was significant biases the results (Freeman 1989). So the result gives the largest carry-over
that the data leave possible, and states the conclusions in words. A carry-over that is the same
after every condition looks like a period effect and cannot be detected. If participants react to
the conditions differently, these tests reject too often (see the table of error rates): an apparent
carry-over may then be such differences.

Sources: Williams 1949, Aust J Sci Res A 2, 149; Jones and Kenward 2014, Design and Analysis of
Cross-Over Trials; Freeman 1989, Stat Med 8, 1421.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from app.science.statistics.arrays import FloatArray
from app.science.statistics.mixed.carry_over_orders import Orders, describe_orders
from app.science.statistics.mixed.carry_over_words import Conclusion, conclude
from app.science.statistics.mixed.design import Design, build_design
from app.science.statistics.mixed.model import MixedModel, fit_mixed_model
from app.science.statistics.mixed.term_tests import Estimate, TermTest, estimate, term_test
from app.science.statistics.mixed.terms import Covariate, Factor, Label, ModelError, factor

CONDITION, PERIOD, CARRY_OVER, SEQUENCE = "condition", "period", "carry_over", "sequence"


@dataclass(frozen=True)
class CarryOverDifference:
    """The carry-over of condition `a` minus that of condition `b`, in units of the measure."""

    a: str
    b: str
    value: Estimate


@dataclass(frozen=True)
class CarryOver:
    """Diagnostics of order, sequence and carry-over of one measure.

    Attributes:
        orders: the orders of the conditions, and their balance.
        condition: F test of the condition, adjusted for period and carry-over.
        period, carry_over: F tests.
        sequence: F test between participants; None if the orders do not allow it.
        differences: the differences of carry-over between conditions, with 95 % intervals.
        largest_possible: the largest carry-over difference that the intervals leave possible, in
            units of the measure.
        left_out: observations without a known previous condition, other than the first period.
        converged: whether the fit converged.
        conclusions: the most important first.
    """

    orders: Orders
    condition: TermTest
    period: TermTest
    carry_over: TermTest
    sequence: TermTest | None
    differences: tuple[CarryOverDifference, ...]
    largest_possible: float
    left_out: int
    converged: bool
    conclusions: tuple[Conclusion, ...]


def carry_over(
    values: Sequence[float] | FloatArray,
    participants: Sequence[Label],
    conditions: Sequence[Label],
    periods: Sequence[int],
    *,
    further: Sequence[Factor] = (),
) -> CarryOver:
    """Diagnose order, sequence and carry-over of one measure.

    Args:
        values: (N,) finite; a period may have several (hand and foot).
        participants: the participants of the N observations, by name.
        conditions: N conditions; a participant has one in each period.
        periods: N positions in the order, from 1.
        further: other factors of the N observations on which the measure depends, such as the limb.

    An observation whose previous period is not in the data is left out of the models, and counted.

    Raises:
        ModelError: a period has two conditions, there are fewer than two periods, or the orders do
            not separate condition, period and carry-over.
    """
    placed = _conditions_by_period(participants, conditions, periods)
    previous = [placed.get((who, at - 1)) for who, at in zip(participants, periods, strict=True)]
    usable = np.array(
        [at == 1 or before is not None for at, before in zip(periods, previous, strict=True)]
    )
    y = np.asarray(values, dtype=np.float64)[usable]
    names = [who for who, use in zip(participants, usable, strict=True) if use]
    condition = _selected(factor(CONDITION, conditions), usable)
    before = [str(each) if each is not None else None for each in previous]
    design = build_design(
        [
            condition,
            _selected(factor(PERIOD, periods), usable),
            *(_selected(each, usable) for each in further),
        ],
        [
            _previous_condition(
                condition,
                [each for each, use in zip(before, usable, strict=True) if use],
            )
        ],
    )
    return _diagnosed(
        fit_mixed_model(y, names, design),
        _sequence(y, names, design, placed),
        describe_orders(placed, condition.levels),
        int((~usable).sum()),
    )


def _diagnosed(
    model: MixedModel, sequence: TermTest | None, orders: Orders, left_out: int
) -> CarryOver:
    tested, period = term_test(model, CARRY_OVER), term_test(model, PERIOD)
    differences = _differences(model, model.design.factor(CONDITION).levels)
    largest = max(max(abs(each.value.low), abs(each.value.high)) for each in differences)
    return CarryOver(
        orders=orders,
        condition=term_test(model, CONDITION),
        period=period,
        carry_over=tested,
        sequence=sequence,
        differences=differences,
        largest_possible=largest,
        left_out=left_out,
        converged=model.converged,
        conclusions=conclude(orders, (tested, period, sequence), largest),
    )


def _conditions_by_period(
    participants: Sequence[Label], conditions: Sequence[Label], periods: Sequence[int]
) -> dict[tuple[Label, int], str]:
    """Return the condition of each participant in each period."""
    placed: dict[tuple[Label, int], str] = {}
    for who, condition, at in zip(participants, conditions, periods, strict=True):
        if placed.setdefault((who, at), str(condition)) != str(condition):
            raise ModelError(
                f"Participant {who} has the conditions {placed[who, at]} and {condition} in period "
                f"{at}; give one per period."
            )
    if {at for _, at in placed} != set(range(1, max(periods) + 1)) or max(periods) == 1:
        raise ModelError("Periods must count from 1 without a gap, and there must be two or more.")
    return placed


def _selected(term: Factor, usable: np.ndarray) -> Factor:
    return Factor(term.name, term.levels, term.codes[usable])


def _previous_condition(condition: Factor, before: Sequence[str | None]) -> Covariate:
    """Return the covariate of the previous condition, in deviation coding.

    The first level is minus the sum of the others.
    """
    columns = np.zeros((len(before), len(condition.levels) - 1))
    for row, level in enumerate(before):
        if level is None:
            continue
        at = condition.levels.index(level)
        columns[row] = -1.0 if at == 0 else np.eye(columns.shape[1])[at - 1]
    return Covariate(CARRY_OVER, columns, condition.levels[1:], (0.0,) * columns.shape[1])


def _differences(model: MixedModel, levels: tuple[str, ...]) -> tuple[CarryOverDifference, ...]:
    names = model.design.names
    rows = np.zeros((len(levels), len(names)))
    for at, level in enumerate(levels[1:], 1):
        rows[at, names.index(f"{CARRY_OVER}[{level}]")] = 1.0
    rows[0] = -rows[1:].sum(axis=0)
    return tuple(
        CarryOverDifference(levels[a], levels[b], estimate(model, rows[a] - rows[b]))
        for a, b in combinations(range(len(levels)), 2)
    )


def _sequence(
    y: FloatArray,
    names: Sequence[Label],
    design: Design,
    placed: dict[tuple[Label, int], str],
) -> TermTest | None:
    """Return the F test of the participants' orders, if there are more participants than orders."""
    last = max(at for _, at in placed)
    orders = {
        who: "-".join(placed.get((who, at), "?") for at in range(1, last + 1)) for who in names
    }
    if not 1 < len(set(orders.values())) < len(orders):
        return None
    sequence = factor(SEQUENCE, [orders[who] for who in names])
    return term_test(fit_mixed_model(y, names, build_design([*design.factors, sequence])), SEQUENCE)
