"""Tests of the language of score formulas: its laws, limits and errors."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.science.instruments import FormulaError
from app.science.instruments.formula import MAX_DEPTH, names_in, parse_formula
from app.science.instruments.scoring import evaluate
from app.science.instruments.tokens import MAX_LENGTH, MAX_TOKENS

NAMES = frozenset({"q1", "q2", "q3"})
numbers = st.floats(-100, 100).map(lambda value: round(value, 3))


def value_of(text: str, **values: float) -> float:
    """Return the formula's value for one person; NaN if it has none."""
    arrays = {key: np.array([value]) for key, value in values.items()}
    return float(np.ravel(evaluate(parse_formula(text, values.keys()), arrays))[0])


@given(numbers, numbers, numbers)
def test_operators_group_as_in_arithmetic(a: float, b: float, c: float) -> None:
    """Products bind tighter than sums, and equal operators group from the left."""
    assert value_of("q1 + q2 * q3", q1=a, q2=b, q3=c) == a + b * c
    assert value_of("q1 - q2 - q3", q1=a, q2=b, q3=c) == (a - b) - c
    assert value_of("-q1 * q2 - -q3", q1=a, q2=b, q3=c) == -a * b + c
    assert value_of("q1 - (q2 - q3)", q1=a, q2=b, q3=c) == a - (b - c)


@given(numbers, numbers, numbers)
def test_functions_take_any_number_of_values(a: float, b: float, c: float) -> None:
    """mean, sum, min and max take any number of values."""
    given_values = {"q1": a, "q2": b, "q3": c}
    assert value_of("mean(q1, q2, q3)", **given_values) == (a + b + c) / 3
    assert value_of("sum(q1, q2, q3)", **given_values) == a + b + c
    assert value_of("min(q1, q2, q3)", **given_values) == min(a, b, c)
    assert value_of("max(q1, max(q2, q3))", **given_values) == max(a, b, c)


@pytest.mark.parametrize(
    "formula", ["q1 + q2", "0 * q1", "min(q1, q2)", "max(q2, q1)", "mean(q1, q2)", "q1 / q1", "-q1"]
)
def test_a_missing_answer_makes_the_value_missing(formula: str) -> None:
    """A missing answer makes the value missing, even in a minimum or times zero."""
    assert math.isnan(value_of(formula, q1=math.nan, q2=1.0))


@pytest.mark.parametrize("formula", ["1 / 0", "0 / 0", "q1 / (q1 - q1)", "1 / (1 / 0)"])
def test_dividing_by_zero_gives_no_value(formula: str) -> None:
    """A division by zero has no value, also in the middle of a formula."""
    assert math.isnan(value_of(formula, q1=2.0))


def test_a_column_has_the_values_of_its_rows() -> None:
    """Evaluating a column gives the value of each row evaluated alone."""
    column = np.array([1.0, np.nan, 3.0])
    result = evaluate(parse_formula("(q1 + 1) * 2", {"q1"}), {"q1": column})
    np.testing.assert_array_equal(result, [4.0, np.nan, 8.0])


def test_the_names_of_a_formula_are_its_items() -> None:
    """The names of a formula are its items, each once, without functions."""
    assert names_in(parse_formula("mean(q1, -q2) / (q1 + 4)", NAMES)) == {"q1", "q2"}


def test_a_formula_never_gives_negative_zero() -> None:
    """A result of negative zero becomes zero."""
    assert math.copysign(1, value_of("-q1", q1=0.0)) == 1


@pytest.mark.parametrize(
    ("formula", "position", "expected_message"),
    [
        ("q1 + q9", 5, "'q9' is unknown"),
        ("q1 + ", 4, "the formula ends"),
        ("", 0, "the formula ends"),
        ("q1 q2", 3, "cannot follow"),
        ("(q1 + q2", 8, "not closed"),
        ("q1)", 2, "cannot follow"),
        ("mean q1", 5, "in parentheses"),
        ("mean()", 5, "there is ')'"),
        ("q1 ** 2", 4, "there is '*'"),
        ("q1 // 2", 4, "there is '/'"),
        ("q1 % 2", 3, "'%' does not begin"),
        ("q1.real", 2, "'.' does not begin"),
        ("__import__('os')", 11, "does not begin"),
        ("__import__(1)", 0, "'__import__' is unknown"),
        ("q1 + 1e5", 5, "'1' does not begin"),
        ("q1 if q2 else q3", 3, "cannot follow"),
        ("Q1", 0, "'Q1' is unknown"),
    ],
)
def test_an_invalid_formula_is_rejected_at_the_right_character(
    formula: str, position: int, expected_message: str
) -> None:
    """A syntax error points at the first invalid character and gives the reason."""
    with pytest.raises(FormulaError, match=r".") as caught:
        parse_formula(formula, NAMES)
    assert caught.value.position == position
    assert expected_message in caught.value.message
    assert caught.value.remedy


def test_a_misspelt_name_gets_a_suggestion() -> None:
    """The error about an unknown name suggests the closest key and lists all keys."""
    with pytest.raises(FormulaError, match="Did you mean ownership"):
        parse_formula("ownershp / 5", {"ownership", "q1"})


@pytest.mark.parametrize(
    "formula",
    [
        "(" * (MAX_DEPTH + 1) + "q1" + ")" * (MAX_DEPTH + 1),
        "-" * (MAX_DEPTH + 1) + "q1",
        "+".join(["1"] * MAX_TOKENS),
        "q1" + " " * MAX_LENGTH,
    ],
)
def test_formulas_over_the_limits_are_rejected(formula: str) -> None:
    """Formulas over the limits of nesting, parts or length are rejected."""
    with pytest.raises(FormulaError, match="more than"):
        parse_formula(formula, NAMES)


def test_formulas_at_the_limits_are_evaluated() -> None:
    """The longest and the most nested formula that are allowed can be evaluated."""
    assert value_of("+".join(["1"] * 200)) == 200
    assert value_of("(" * MAX_DEPTH + "q1" + ")" * MAX_DEPTH, q1=3.0) == 3


@given(st.text("q123+-*/(),. meansumxi", max_size=40))
def test_any_text_is_a_formula_or_a_formula_error(text: str) -> None:
    """Any text is parsed or raises a formula error, never another exception."""
    try:
        tree = parse_formula(text, NAMES)
    except FormulaError:
        return
    assert names_in(tree) <= NAMES
