"""Tests of doubts about answers that are valid one by one, but hardly as a whole."""

from itertools import cycle, islice

import pytest

from app.science.instruments import reversed_items
from app.science.instruments.table import scored_csv
from tests.science.instruments.helpers import shipped

_KARAS = shipped("karas2020")
_ITEMS = [f"q{number}" for number in range(1, 15)]
_REVERSED = {"q2", "q3", "q5", "q9", "q11"}


def _table(rows: list[list[int]], ids: list[str] | None = None, name: str = "id") -> str:
    named = ids or [f"P{at}" for at in range(len(rows))]
    lines = [",".join([who, *map(str, row)]) for who, row in zip(named, rows, strict=True)]
    return "\n".join([",".join([name, *_ITEMS]), *lines])


def _person(agreement: int, *, already_reversed: bool) -> list[int]:
    """Answer every item alike in its meaning; reverse-keyed items as asked, or turned already."""
    return [
        8 - agreement if item in _REVERSED and not already_reversed else agreement
        for item in _ITEMS
    ]


def test_the_reversed_items_are_those_that_the_formulas_subtract() -> None:
    """Of the embodiment questionnaire, q2, q3, q5, q9 and q11 are subtracted, as printed."""
    turning = reversed_items(_KARAS)
    assert set(turning) - {"q4"} >= {"q2", "q3", "q9", "q11"}
    assert turning["q9"] == ("agency", ["q6", "q7", "q8"])


def test_items_that_the_file_has_already_reversed_are_doubted() -> None:
    """Reverse-keyed items that agree with their scale are named; raw answers are not."""
    people = list(range(1, 8)) * 2
    turned = [_person(one, already_reversed=True) for one in people]
    notes = scored_csv(_KARAS, _table(turned)).notes
    told = [note for note in notes if "q9 is reversed in agency" in note]
    assert "(r = 1.00)" in told[0]
    assert "put the raw answers into it" in told[0]
    raw = [_person(one, already_reversed=False) for one in people]
    assert scored_csv(_KARAS, _table(raw)).notes == ()


@pytest.mark.parametrize(
    ("answers", "said"),
    [
        ([1, 2, 3, 4, 5], "are 1 to 5, on a scale of 1 to 7"),
        ([2, 3, 4, 5, 6, 7], "are 2 to 7, on a scale of 1 to 7"),
        ([1, 2, 3, 4, 5, 6, 7], None),
        ([1, 1, 1, 1, 1, 1, 2, 2, 2, 3], None),
        ([7, 7, 7, 6, 6, 5], None),
    ],
    ids=["five steps", "from 2", "all", "rarely agreed", "never disagreed"],
)
def test_a_scale_whose_end_hundreds_of_answers_never_reach_is_doubted(
    answers: list[int], said: str | None
) -> None:
    """1 to 5 used alike on 1 to 7 is doubted; an end that is rare before it is missing is not."""
    numbers = cycle(answers)
    rows = [list(islice(numbers, len(_ITEMS))) for _ in range(20)]
    notes = [note for note in scored_csv(_KARAS, _table(rows)).notes if "on a scale of" in note]
    assert len(notes) == (said is not None)
    assert said is None or f"all 280 answers to q1 to q14 {said}" in notes[0]
    few = [note for note in scored_csv(_KARAS, _table(rows[:14])).notes if "on a scale" in note]
    assert few == []


def test_an_id_with_two_forms_that_nothing_tells_apart_is_noted() -> None:
    """P1 twice with other answers is noted with its lines; a column of conditions explains it."""
    rows = [[1 + (at + item) % 7 for item in range(14)] for at in range(4)]
    ids = ["P1", "P2", "P3", "P1"]
    (note,) = scored_csv(_KARAS, _table(rows, ids)).notes
    assert note.startswith("P1 in lines 2 and 5: the same in id, with other answers")
    assert scored_csv(_KARAS, _table(rows, ids, "group")).notes == (
        note.replace("in id", "in group"),
    )
    told_apart = [f"{who},{at}" for at, who in enumerate(ids)]
    assert scored_csv(_KARAS, _table(rows, told_apart, "id,condition")).notes == ()
    groups = ["a", "b", "a", "b"]
    assert scored_csv(_KARAS, _table(rows, groups, "group")).notes == ()
    assert (
        "a in lines 2 and 4; b in lines 3 and 5"
        in scored_csv(_KARAS, _table(rows, groups)).notes[0]
    )
