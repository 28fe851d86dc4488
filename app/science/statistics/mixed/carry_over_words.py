"""What follows from tests of carry-over, period and sequence, in words, and what does not."""

from dataclasses import dataclass

from app.science.statistics.mixed.carry_over_orders import Orders
from app.science.statistics.mixed.term_tests import TermTest

_ALPHA = 0.05


@dataclass(frozen=True)
class Conclusion:
    """One thing that follows, or does not: `code` for machines, `text` for people."""

    code: str
    text: str


def conclude(
    orders: Orders, tests: tuple[TermTest, TermTest, TermTest | None], largest: float
) -> tuple[Conclusion, ...]:
    """Return what follows from the tests of carry-over, period and (where there is one) sequence.

    Args:
        orders: of the conditions.
        tests: of carry-over, period and sequence.
        largest: the largest carry-over difference that the intervals leave possible.
    """
    carried, period, sequence = tests
    found = [_about_carry_over(carried, largest), _about_period(period), _about_sequence(sequence)]
    if not orders.balanced:
        found.append(
            Conclusion(
                "unbalanced",
                "Positions or neighbours of the conditions are not balanced. The tests allow for "
                "it, but condition, period and carry-over share part of the evidence.",
            )
        )
    found.append(
        Conclusion(
            "limits",
            "A carry-over that is the same after every condition looks like a difference between "
            "periods and cannot be told from it. No choice of analysis should depend on these "
            "tests.",
        )
    )
    return tuple(found)


def _about_carry_over(test: TermTest, largest: float) -> Conclusion:
    if test.p < _ALPHA:
        return Conclusion(
            "carry_over_shown",
            f"What the condition before left behind made a difference ({_told(test)}). Report the "
            "effect of the condition beside it, and do not read raw means of conditions alone.",
        )
    return Conclusion(
        "carry_over_not_shown",
        f"No carry-over was shown ({_told(test)}). This does not show that there is none: "
        f"differences of up to {largest:.3g} remain possible.",
    )


def _about_period(test: TermTest) -> Conclusion:
    if test.p < _ALPHA:
        return Conclusion(
            "period_shown",
            f"The measure changed over the periods ({_told(test)}), by practice, fatigue or time. "
            "With balanced orders the comparison of conditions is not biased by it.",
        )
    return Conclusion("period_not_shown", f"No change over the periods was shown ({_told(test)}).")


def _about_sequence(test: TermTest | None) -> Conclusion:
    if test is None:
        return Conclusion(
            "sequence_untested",
            "The orders cannot be compared: there must be at least two, and more participants than "
            "orders.",
        )
    if test.p < _ALPHA:
        return Conclusion(
            "sequence_shown",
            f"Participants with different orders differ ({_told(test)}). Whether the order does it "
            "or who happened to have it, these data cannot tell.",
        )
    return Conclusion(
        "sequence_not_shown",
        f"No difference between orders was shown ({_told(test)}); the test is between participants "
        "and finds large differences only.",
    )


def _told(test: TermTest) -> str:
    return f"F({test.df_term}, {test.df_error:.1f}) = {test.f:.2f}, p = {test.p:.3g}"
