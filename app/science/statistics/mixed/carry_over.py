"""Order, sequence and carry-over: did it matter when a condition came, and after which?

In a Williams design every condition stands equally often at every position and follows every other
equally often. Then differences between positions (practice, fatigue) and a *first-order carry-over*
(what the condition before leaves behind) can be told from the effect of the condition itself. Both
are estimated in one linear mixed model of a measure,

    y = condition + period + carry-over + ... + participant + error,

carry-over being the deviation that each previous condition causes from the mean of all; the first
period has none. A second model tests the *sequence*, which order a participant had. It varies
between participants only, so it has their number of degrees of freedom and finds little; and it
carries the interaction of condition and period as well.

These are diagnostics. What they cannot do is license a choice of analysis: a test with a dozen
participants misses carry-over of the size of the effect itself, and analysing only the first period
because this test came out significant biases what is reported (Freeman 1989). So the result gives
how large a carry-over the data leave possible, and says in words what follows. A carry-over that is
the same after every condition looks like period and cannot be seen. Where participants react to the
conditions differently, these tests reject too often (table of error rates): what is shown may then
be reactions.

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
    """How much more is left behind by condition `a` than by `b`, in units of the measure."""

    a: str
    b: str
    value: Estimate


@dataclass(frozen=True)
class CarryOver:
    """Diagnostics of one measure.

    Attributes:
        orders: how the conditions were ordered, and how balanced.
        condition: F test of the condition beside period and carry-over.
        period, carry_over: F tests.
        sequence: F test between participants; None where the orders do not allow it.
        differences: of carry-over between conditions, with 95 % intervals.
        largest_possible: the largest carry-over difference that the intervals leave possible, in
            units of the measure.
        left_out: observations without a known previous condition, other than the first period.
        converged: of the fits.
        conclusions: in order of weight.
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
    """Diagnose one measure.

    Args:
        values: (N,) finite; several a period are allowed (hand and foot).
        participants: N names.
        conditions: N conditions; one of them in each period of a participant.
        periods: N places in the order, from 1.
        further: other factors of the N observations that the measure depends on, such as the limb.

    An observation whose period before is not among the data is left out of the models, and counted.

    Raises:
        ModelError: a period has two conditions, there are fewer than two periods, or the orders do
            not tell condition, period and carry-over apart.
    """
    placed = _placed(participants, conditions, periods)
    previous = [placed.get((who, at - 1)) for who, at in zip(participants, periods, strict=True)]
    known = np.array(
        [at == 1 or before is not None for at, before in zip(periods, previous, strict=True)]
    )
    y = np.asarray(values, dtype=np.float64)[known]
    names = [who for who, kept in zip(participants, known, strict=True) if kept]
    condition = _kept(factor(CONDITION, conditions), known)
    before = [str(one) if one is not None else None for one in previous]
    design = build_design(
        [condition, _kept(factor(PERIOD, periods), known), *(_kept(one, known) for one in further)],
        [_carried(condition, [one for one, kept in zip(before, known, strict=True) if kept])],
    )
    return _diagnosed(
        fit_mixed_model(y, names, design),
        _sequence(y, names, design, placed),
        describe_orders(placed, condition.levels),
        int((~known).sum()),
    )


def _diagnosed(
    model: MixedModel, sequence: TermTest | None, orders: Orders, left_out: int
) -> CarryOver:
    tested, period = term_test(model, CARRY_OVER), term_test(model, PERIOD)
    differences = _differences(model, model.design.factor(CONDITION).levels)
    largest = max(max(abs(one.value.low), abs(one.value.high)) for one in differences)
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


def _placed(
    participants: Sequence[Label], conditions: Sequence[Label], periods: Sequence[int]
) -> dict[tuple[Label, int], str]:
    """Which condition each participant had in each period."""
    placed: dict[tuple[Label, int], str] = {}
    for who, condition, at in zip(participants, conditions, periods, strict=True):
        if placed.setdefault((who, at), str(condition)) != str(condition):
            raise ModelError(
                f"Participant {who} has the conditions {placed[who, at]} and {condition} in period "
                f"{at}; a period has one."
            )
    if {at for _, at in placed} != set(range(1, max(periods) + 1)) or max(periods) == 1:
        raise ModelError("Periods must count from 1 without a gap, and there must be two or more.")
    return placed


def _kept(one: Factor, known: np.ndarray) -> Factor:
    return Factor(one.name, one.levels, one.codes[known])


def _carried(condition: Factor, before: Sequence[str | None]) -> Covariate:
    """Deviations by previous condition: the first level is minus the sum of the others."""
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
    """F test of the order had, if there are more participants than orders."""
    last = max(at for _, at in placed)
    orders = {
        who: "-".join(placed.get((who, at), "?") for at in range(1, last + 1)) for who in names
    }
    if not 1 < len(set(orders.values())) < len(orders):
        return None
    sequence = factor(SEQUENCE, [orders[who] for who in names])
    return term_test(fit_mixed_model(y, names, build_design([*design.factors, sequence])), SEQUENCE)
