"""Tests of tables of cells from tidy rows: order, duplicates, missing and invalid rows."""

import math
from collections.abc import Sequence

import numpy as np
import pytest

from app.science.statistics import Cells, StatisticsError, TooFewData, UnusableTable, cells_of
from app.science.statistics.levels import ordered_levels, place_of

_ROWS = [
    ("P2", "350", "hand", "4"), ("P2", "0", "hand", "7"), ("P2", "125", "hand", "5"),
    ("P1", "0", "hand", "6"), ("P1", "350", "hand", "NA"), ("P1", "125", "hand", "6.5"),
    ("P2", "0", "foot", "3"), ("P2", "125", "foot", "2"), ("P2", "350", "foot", "1"),
    ("P1", "0", "foot", "3"), ("P1", "125", "foot", "2"), ("P1", "125", "foot", "4"),
    ("P1", "350", "foot", "1"),
]  # fmt: skip


def _cells(rows: Sequence[tuple[str, str, str, str | float]]) -> Cells:
    subjects, latency, limb, measure = zip(*rows, strict=True)
    return cells_of(subjects, {"latency": latency, "limb": limb}, measure, measure_name="score")


def test_rows_find_their_cells_whatever_their_order() -> None:
    """The order of the rows changes only the order of the subjects; levels are sorted."""
    found, turned = _cells(_ROWS), _cells(_ROWS[::-1])
    assert found.subjects == ("P2", "P1")
    assert found.levels == (("0", "125", "350"), ("foot", "hand"))
    assert found.values[0].tolist() == [[3.0, 7.0], [2.0, 5.0], [1.0, 4.0]]
    np.testing.assert_array_equal(turned.values[::-1], found.values)


def test_averaged_and_missing_rows_are_counted() -> None:
    """Averaged rows and empty cells are counted, and incomplete subjects are listed."""
    found = _cells(_ROWS)
    assert found.values[1, 1, 0] == 3.0
    assert (found.n_averaged, found.n_missing, found.n_empty) == (1, 1, 1)
    complete = found.complete()
    assert (complete.subjects, complete.left_out) == (("P2",), ("P1",))
    assert complete.values.shape == (1, 3, 2)


def test_a_missing_row_is_a_missing_value() -> None:
    """A missing row counts as a missing value, but not as an empty row."""
    found = _cells([row for row in _ROWS if row[3] != "NA"])
    assert (found.n_missing, found.n_empty) == (1, 0)
    assert found.complete().left_out == ("P1",)


def test_the_mean_over_a_factor_takes_complete_subjects() -> None:
    """A subject's mean over a factor is missing if one of the subject's cells is missing."""
    by_latency = _cells(_ROWS).of_factor(1)
    assert by_latency[0].tolist() == [5.0, 3.5, 2.5]
    assert by_latency[1, :2].tolist() == [4.5, 4.75]
    assert math.isnan(by_latency[1, 2])


def test_means_of_decimals_tie() -> None:
    """0.1, 0.2 and 0.3 average to exactly 0.2."""
    rows = [("A", level, "x", value) for level in "12" for value in ("0.1", "0.2", "0.3")]
    rows += [("B", level, "x", "0.2") for level in "12"]
    rows += [(who, level, "y", "1") for who in "AB" for level in "12"]
    found = _cells(rows)
    assert found.values[0, 0, 0] == found.values[1, 0, 0] == 0.2


@pytest.mark.parametrize(
    ("found", "ordered"),
    [
        (["350", "0", "125"], ("0", "125", "350")),
        (["10", "9.5", "-1"], ("-1", "9.5", "10")),
        (["0.0", "0", "1.00"], ("0", "1.00")),
        (["10 ms", "2 ms", "0 ms"], ("0 ms", "2 ms", "10 ms")),
        (["Post", "Pre", "none"], ("none", "Post", "Pre")),
    ],
)
def test_levels_are_ordered_as_people_would(found: list[str], ordered: tuple[str, ...]) -> None:
    """Numeric levels are sorted by value, others by their text and the numbers in it."""
    assert ordered_levels(found) == ordered
    assert ordered_levels(found[::-1]) == ordered


def test_a_level_is_found_by_its_number() -> None:
    """ "0.0" finds the level "0"; an unknown level raises an error that lists the existing ones."""
    assert place_of(("0", "125"), "0.0") == 0
    with pytest.raises(StatisticsError, match="there are: 0, 125"):
        place_of(("0", "125"), "350")


@pytest.mark.parametrize(
    ("row", "words"),
    [
        (("P1", "0", "hand", "often"), r"Line 14, column 'score': 'often' is not a finite number"),
        (("P1", "0", "hand", "inf"), r"Line 14, column 'score': 'inf'"),
        (("P1", "0", "hand", math.inf), r"Line 14, column 'score': inf"),
        (("P1", "0", "hand", "1_000"), r"'1_000' is not a finite number"),
        ((" ", "0", "hand", "1"), r"Line 14, column 'subject': ' ' is not a name"),
        (("P1", "NA", "hand", "1"), r"Line 14, column 'latency': 'NA' is not a name"),
    ],
)
def test_an_invalid_row_is_rejected_with_its_line(
    row: tuple[str, str, str, str | float], words: str
) -> None:
    """An invalid row raises an error that states its line, column and value."""
    with pytest.raises(UnusableTable, match=words):
        _cells([*_ROWS, row])


def test_tables_that_are_too_small_are_rejected() -> None:
    """No rows, one subject, one level, unequal columns and no factor are rejected."""
    with pytest.raises(TooFewData, match="no row"):
        cells_of([], {"latency": []}, [])
    with pytest.raises(TooFewData, match="only one subject, 'P1'"):
        cells_of(["P1", "P1"], {"latency": ["0", "1"]}, [1.0, 2.0])
    with pytest.raises(TooFewData, match="'latency' has only one level, '0'"):
        cells_of(["P1", "P2"], {"latency": ["0", "0"]}, [1.0, 2.0])
    with pytest.raises(StatisticsError, match=r"\[1, 2\] rows"):
        cells_of(["P1", "P2"], {"latency": ["0"]}, [1.0, 2.0])
    with pytest.raises(StatisticsError, match="No within-subject factor"):
        cells_of(["P1"], {}, [1.0])
