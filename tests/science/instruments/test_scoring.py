"""Tests of scoring answers: properties, the expert of the thesis, and invalid answers."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest

from app.science.instruments import (
    AnswerError,
    InstrumentTableError,
    Score,
    score_answers,
)
from app.science.instruments.table import score_table
from tests.science.instruments.helpers import shipped, small

KARAS = shipped("karas2020")
SCORED = tuple(f"q{number}" for number in range(1, 13))
EXPERT = dict(zip(SCORED, (2, 1, 1, 5, 1, 7, 7, 2, 1, 6, 1, 3), strict=True))


def test_the_expert_of_table_7_2() -> None:
    """The expert's hand phase at 0 ms scores 8, 7, 4 and 1.04 (Karas 2020, table 7.2)."""
    scores = score_answers(KARAS, EXPERT)
    assert {key: scores[key] for key in ("ownership", "agency", "location")} == {
        "ownership": 8,
        "agency": 7,
        "location": 4,
    }
    assert scores["soe_thesis"] == pytest.approx(1.0407407407407407, abs=1e-15)
    assert scores["soe_rescaled"] == pytest.approx(1.5 * 1.0407407407407407, abs=1e-15)


def test_answers_are_recoded_before_they_are_scored() -> None:
    """Reversed items are recoded before scoring; without recoding, scores would be 4, 15 and 8."""
    raw = score_answers(replace(KARAS, recode=None), EXPERT)
    recoded = score_answers(KARAS, EXPERT)
    components = ("ownership", "agency", "location")
    assert [raw[key] for key in components] == [4, 15, 8]
    assert [recoded[key] for key in components] == [8, 7, 4]


def test_agreeing_with_everything_is_not_embodiment() -> None:
    """Answers of 7 to every item score -3, 6, 3 and 0.4222, since five items are reversed."""
    scores = score_answers(KARAS, dict.fromkeys(SCORED, 7))
    assert (scores["ownership"], scores["agency"], scores["location"]) == (-3, 6, 3)
    assert scores["soe_thesis"] == pytest.approx(0.42222222222222222, abs=1e-15)


def test_a_missing_item_empties_only_the_scores_that_need_it() -> None:
    """Without q3 ownership and the total are missing; agency and location are not."""
    scores = score_answers(KARAS, {**EXPERT, "q3": None})
    assert scores == {
        "ownership": None,
        "agency": 7,
        "location": 4,
        "soe_thesis": None,
        "soe_rescaled": None,
    }


@pytest.mark.parametrize("score", KARAS.scores, ids=lambda score: score.key)
def test_stated_ranges_are_reached_and_never_left(score: Score) -> None:
    """Over all extreme answers the lowest and highest scores are those that the scores state."""
    corners = np.array(list(itertools.product((1.0, 7.0), repeat=len(SCORED))))
    table = score_table(KARAS, pd.DataFrame(corners, columns=list(SCORED)))
    assert (table[score.key].min(), table[score.key].max()) == (score.minimum, score.maximum)


def test_unscored_items_change_nothing() -> None:
    """Items 13 and 14 and the open prompt do not change any score."""
    extra: dict[str, object] = {
        **EXPERT,
        "q13": 7,
        "q14": None,
        "problems": "The mirror was far away.",
    }
    assert score_answers(KARAS, extra) == score_answers(KARAS, EXPERT)
    assert KARAS.scored_items == set(SCORED)


def test_a_table_scores_each_row_like_a_person() -> None:
    """Each row of a table gets the scores of its answers alone; ids and index are kept."""
    rows: list[dict[str, int | None]] = [
        dict(EXPERT),
        dict.fromkeys(SCORED, 7),
        {**EXPERT, "q10": None},
    ]
    frame = pd.DataFrame(rows, index=[5, 6, 9])
    frame.insert(0, "id", ["a", "b", "c"])
    table = score_table(KARAS, frame)
    assert list(table.columns) == ["id", *(score.key for score in KARAS.scores)]
    assert list(table.index) == [5, 6, 9]
    for position, row in enumerate(rows):
        for key, value in score_answers(KARAS, row).items():
            cell = table[key].iloc[position]
            assert math.isnan(cell) if value is None else cell == value


def test_a_missing_column_empties_the_scores_that_need_it() -> None:
    """A table without q11 still gives ownership and agency."""
    frame = pd.DataFrame([EXPERT]).drop(columns="q11")
    table = score_table(KARAS, frame)
    assert table["location"].isna().all()
    assert (table["ownership"].iloc[0], table["agency"].iloc[0]) == (8, 7)


def test_a_yes_counts_one() -> None:
    """A yes of a yes/no item counts 1, in answers and in tables."""
    counted = small(scores=(Score("n", {"en": "n"}, "yes + 0"),))
    assert score_answers(counted, {"yes": True}) == {"n": 1}
    assert score_table(counted, pd.DataFrame({"yes": ["no", 1, "true"]}))["n"].tolist() == [0, 1, 1]


@pytest.mark.parametrize("value", [0, 8, 3.5, -1, math.inf, "five", True])
def test_an_answer_off_the_scale_is_rejected(value: object) -> None:
    """An answer off the scale raises an error that names item, value and valid range."""
    with pytest.raises(AnswerError, match="whole number from 1 to 7") as caught:
        score_answers(KARAS, {**EXPERT, "q4": value})
    assert (caught.value.item, caught.value.value, caught.value.row) == ("q4", value, None)


def test_a_table_names_the_row_of_a_wrong_answer() -> None:
    """The error about an answer in a table names its row, counted from 1, whatever the index."""
    frame = pd.DataFrame({"q1": [1, 2, 8]}, index=[10, 20, 30])
    with pytest.raises(AnswerError, match="Row 3: item q1") as caught:
        score_table(KARAS, frame)
    assert caught.value.row == 3


def test_an_answer_to_an_unknown_item_is_rejected() -> None:
    """An answer to an unknown item is rejected, since a misspelt key would go unnoticed."""
    with pytest.raises(AnswerError, match="q99"):
        score_answers(KARAS, {**EXPERT, "q99": 3})


@pytest.mark.parametrize(
    ("columns", "expected_message"),
    [
        (["id", "age"], "No column is an item"),
        (["q1", "Q1"], "more than once"),
        (["id", "id", "q1"], "more than once"),
        (["ownership", "q1"], "name of a score"),
    ],
)
def test_tables_that_cannot_be_scored_are_rejected(
    columns: list[str], expected_message: str
) -> None:
    """Tables without items, with duplicate columns or with score names as columns are rejected."""
    with pytest.raises(InstrumentTableError, match=expected_message):
        score_table(KARAS, pd.DataFrame([[1] * len(columns)], columns=columns))
