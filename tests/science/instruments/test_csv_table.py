"""Tests of scoring CSV files as written by spreadsheets."""

import csv
import io

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.science.instruments import InstrumentTableError, score_answers
from app.science.instruments.table import score_csv, scored_csv
from tests.science.instruments.helpers import shipped

KARAS = shipped("karas2020")
ITEMS = [f"q{number}" for number in range(1, 13)]
EXPERT = "2,1,1,5,1,7,7,2,1,6,1,3"
SCORES = "ownership,agency,location,soe_thesis,soe_rescaled"
HEADER = "id," + ",".join(ITEMS)
EXPECTED = f"id,{SCORES}\np1,8.0,7.0,4.0,1.0407407407407407,1.5611111111111111\n"


@given(st.lists(st.lists(st.integers(1, 7), min_size=12, max_size=12), max_size=5))
def test_every_digit_of_a_score_is_written(rows: list[list[int]]) -> None:
    """Scores read back from the CSV equal the computed scores exactly."""
    text = "\n".join([",".join(ITEMS), *(",".join(map(str, row)) for row in rows)])
    back = list(csv.DictReader(io.StringIO(score_csv(KARAS, text))))
    assert [{key: float(cell) for key, cell in row.items()} for row in back] == [
        score_answers(KARAS, dict(zip(ITEMS, row, strict=True))) for row in rows
    ]


@pytest.mark.parametrize(
    "text",
    [
        f"{HEADER}\np1,{EXPERT}\n",
        f"\ufeff{HEADER}\r\np1,{EXPERT}\r\n",
        f"{HEADER}\n\n\np1,{EXPERT}",
        f"\n{HEADER.upper().replace('ID', 'id')}\np1,{EXPERT}\n",
        f"{HEADER}\np1,{EXPERT}\n".replace(",", ";"),
        f"{HEADER}\np1,{EXPERT}\n".replace(",", "\t"),
        f"{HEADER}\np1,{EXPERT.replace(',', '.0,')}.0\n",
        f"{HEADER}\np1,{EXPERT}\n".replace(",", ";").replace(";7", ";7,0"),
        f'"id",{",".join(f" {item} " for item in ITEMS)}\n"p1",{EXPERT}\n',
        f'{HEADER},q13,Q14,problems\np1,{EXPERT},7,,"It was, well, dark"\n',
    ],
    ids=["plain", "bom-crlf", "blank", "upper", "semicolon", "tab", "3.0", "3,0", "quoted", "more"],
)
def test_the_same_table_in_many_spellings(text: str) -> None:
    """Byte order marks, separators, blank lines, capitals and decimal commas make no difference."""
    assert score_csv(KARAS, text) == EXPECTED


def test_quoted_ids_stay_whole() -> None:
    """Separators, quotes and line breaks inside a quoted id are kept."""
    text = f'{HEADER}\n"a,b ""c""\nd",{EXPERT}\n'
    rows = list(csv.reader(io.StringIO(score_csv(KARAS, text))))
    assert rows[1][0] == 'a,b "c"\nd'


def test_missing_answers_leave_scores_empty() -> None:
    """An empty cell or NA leaves only the scores that need it empty."""
    cells = EXPERT.split(",")
    for missing in ("", "NA", " "):
        row = ",".join([*cells[:2], missing, *cells[3:]])
        assert score_csv(KARAS, f"{HEADER}\np1,{row}\n") == f"id,{SCORES}\np1,,7.0,4.0,,\n"


def test_codes_of_missing_answers_can_be_declared() -> None:
    """-99 is refused as an answer until it is declared, and an id of -99 stays."""
    cells = EXPERT.split(",")
    row = ",".join([*cells[:2], "-99", *cells[3:]])
    with pytest.raises(InstrumentTableError, match="the answer is '-99'"):
        score_csv(KARAS, f"{HEADER}\np1,{row}\n")
    scored = scored_csv(KARAS, f"{HEADER}\n-99,{row}\n", missing=["-99.0"])
    assert scored.text == f"id,{SCORES}\n-99,,7.0,4.0,,\n"


def test_rows_that_are_the_same_in_every_cell_are_named() -> None:
    """A form that was copied twice is named by its lines; without ids, equal answers are not."""
    text = f"{HEADER}\np1,{EXPERT}\np2,{EXPERT}\np1,{EXPERT}\n"
    (note,) = scored_csv(KARAS, text).notes
    assert "lines 2 and 4 are the same in every cell" in note
    without_ids = HEADER.split(",", 1)[1] + f"\n{EXPERT}\n{EXPERT}\n"
    assert scored_csv(KARAS, without_ids).notes == ()


def test_a_header_alone_gives_a_header() -> None:
    """A table without rows gives a result without rows."""
    assert score_csv(KARAS, HEADER) == f"id,{SCORES}\n"


@pytest.mark.parametrize(
    ("text", "expected_message"),
    [
        ("", "empty"),
        (" \n\n", "empty"),
        ('"\n"', "empty"),
        ("id,age\n1,2\n", "No column is an item of karas2020"),
        ("id,q1,Q1\n1,2,3\n", r"'q1' occurs more than once \(columns 2, 3\)"),
        ("id,q1\n\np1,3\np2\n", "Line 4 has 1 cells, but the header has 2"),
        ("id,q1\np1,3,4\n", "Line 2 has 3 cells"),
        ("id,q1\np1,1\n\np2,8\n", r"Row 2 \(line 4\), column q1: the answer is '8'"),
        ("id,Q5\np1,2.5\n", r"Row 1 \(line 2\), column Q5: the answer is '2.5'"),
        ("id,q1\np1,many\n", "whole number from 1 to 7"),
        ("id,q1\np1,1_0\n", "'1_0'"),
        ("id,q1\np1,inf\n", "'inf'"),
        ('id,q1\n"p1,3\n', "cannot be read"),
        ("agency,q1\n1,2\n", "name of a score"),
    ],
)
def test_invalid_tables_are_rejected_with_line_and_column(text: str, expected_message: str) -> None:
    """An invalid table raises an error that states line, column, value and remedy."""
    with pytest.raises(InstrumentTableError, match=expected_message):
        score_csv(KARAS, text)


def test_all_mistakes_of_a_table_are_listed_at_once() -> None:
    """Several invalid answers and short rows are one error, by line; 50 are written out."""
    text = "id;q1;q2\np1;8;3\np2;4\np3;4;many\np4;1,5;0\np5;3;3\n"
    with pytest.raises(InstrumentTableError) as refused:
        score_csv(KARAS, text)
    said = str(refused.value).splitlines()
    assert said[0].startswith("5 mistakes; correct them and score again, nothing was written")
    places = (
        "(line 2), column q1: the answer is '8'",
        "Line 3 has 2 cells",
        "(line 4), column q2: the answer is 'many'",
        "(line 5), column q1: the answer is '1,5'",
        "(line 5), column q2: the answer is '0'",
    )
    assert len(said) == 1 + len(places)
    for line, place in zip(said[1:], places, strict=True):
        assert place in line
    with pytest.raises(InstrumentTableError, match=r"(?s)^60 mistakes.*and 10 more$"):
        score_csv(KARAS, "id,q1\n" + "p,9\n" * 60)


@given(st.text('idq1234567,;\t"\n\r .-8', max_size=60))
def test_any_text_is_a_table_or_a_table_error(text: str) -> None:
    """Any text is read as a table or raises a table error, never another exception."""
    try:
        result = score_csv(KARAS, text)
    except InstrumentTableError:
        return
    assert result.splitlines()[0].endswith(SCORES)
