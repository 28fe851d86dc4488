"""State the conclusions that tests of carry-over, period and sequence do and do not allow."""

from dataclasses import dataclass

from app.science.statistics.mixed.carry_over_orders import Orders
from app.science.statistics.mixed.term_tests import TermTest

_ALPHA = 0.05


@dataclass(frozen=True)
class Conclusion:
    """One conclusion: `code` for programs, `text` for people."""

    code: str
    text: str


def conclude(
    orders: Orders, tests: tuple[TermTest, TermTest, TermTest | None], largest: float
) -> tuple[Conclusion, ...]:
    """Return the conclusions from the tests of carry-over, period and (if there is one) sequence.

    Args:
        orders: the orders of the conditions.
        tests: the tests of carry-over, period and sequence.
        largest: the largest carry-over difference that the intervals leave possible.
    """
    carry_over, period, sequence = tests
    found = [
        _about_carry_over(carry_over, largest),
        _about_period(period),
        _about_sequence(sequence),
    ]
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
            "periods and cannot be distinguished from it. No choice of analysis should depend on "
            "these tests.",
        )
    )
    return tuple(found)


def _about_carry_over(test: TermTest, largest: float) -> Conclusion:
    if test.p < _ALPHA:
        return Conclusion(
            "carry_over_shown",
            f"The previous condition had an after-effect ({_f_of(test)}). Report the "
            "effect of the condition adjusted for it, and do not rely on raw means alone.",
        )
    return Conclusion(
        "carry_over_not_shown",
        f"No carry-over was shown ({_f_of(test)}). This does not show that there is none: "
        f"differences of up to {largest:.3g} remain possible.",
    )


def _about_period(test: TermTest) -> Conclusion:
    if test.p < _ALPHA:
        return Conclusion(
            "period_shown",
            f"The measure changed over the periods ({_f_of(test)}), by practice, fatigue or time. "
            "With balanced orders the comparison of conditions is not biased by it.",
        )
    return Conclusion("period_not_shown", f"No change over the periods was shown ({_f_of(test)}).")


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
            f"Participants with different orders differ ({_f_of(test)}). These data cannot show "
            "whether the order causes it or the participants who happened to have it.",
        )
    return Conclusion(
        "sequence_not_shown",
        f"No difference between orders was shown ({_f_of(test)}); the test is between "
        "participants and detects large differences only.",
    )


def _f_of(test: TermTest) -> str:
    # Without the zero that no p has before its point, as in every table.
    p = "p < .001" if test.p < 0.001 else f"p = {test.p:.3f}".replace("= 0.", "= .")
    return f"F({test.df_term}, {test.df_error:.1f}) = {test.f:.2f}, {p}"
