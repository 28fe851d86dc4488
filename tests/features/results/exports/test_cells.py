"""Tests of the cells of a CSV file."""

import csv
import io

import pandas as pd
import pytest

from app.features.results.analysis.codebook import columns_of
from app.features.results.analysis.tables.context import finished
from app.features.results.exports.writing.cells import csv_pieces, safe_text
from tests.faults.figures import note


def _answers(**columns: object) -> pd.DataFrame:
    """Return one row of the table of answers; columns that are not given are missing."""
    row: dict[str, object] = {column.name: None for column in columns_of("answers")}
    row |= {"simulated": False, "valid": True, **columns}
    return finished(pd.DataFrame([row], dtype=object), "answers")


def _written(**columns: object) -> str:
    return b"".join(csv_pieces("answers", _answers(**columns))).decode()


def _read(text: str) -> dict[str, str]:
    (row,) = csv.DictReader(io.StringIO(text, newline=""))
    return row


@pytest.mark.parametrize(
    "text",
    [
        '=HYPERLINK("http://x","y")',
        "+1",
        "-1",
        "@SUM(A1)",
        "\tx",
        "\rx",
        "\nx",
        " =1",
        '"=1',
        "'=1",
        "\ufeff=1",
        "\uff1d1",
    ],
)
def test_text_that_looks_like_a_formula_is_escaped(text: str) -> None:
    """Text that a spreadsheet would run as a formula gets a leading apostrophe."""
    assert safe_text(text) == f"'{text}"


def test_no_cell_can_be_run_as_a_formula() -> None:
    """No combination of a formula sign with characters that spreadsheets skip can be executed."""
    signs = ("=", "+", "-", "@", "\uff1d", "\uff0b", "\uff0d", "\uff20")
    skipped = (
        "",
        " ",
        "  ",
        "\n",
        "\t",
        "\r",
        "\r\n",
        '"',
        "'",
        "\ufeff",
        "\u200b",
        " \u00a0",
        '\ufeff "',
    )
    texts = [f"{before}{sign}1+1" for before in skipped for sign in signs]
    read = [_read(_written(value_text=text))["value_text"] for text in texts]
    live = [text for text, cell in zip(texts, read, strict=True) if cell != f"'{text}"]
    numbers = [_read(_written(value_number=value))["value_number"] for value in (-1.5, 2e-7)]
    note(35, "formulas in a CSV", "cells written", len(texts))
    note(35, "formulas in a CSV", "live cells", len(live))
    assert live == []
    assert [float(number) for number in numbers] == [-1.5, 2e-7]


@pytest.mark.parametrize("text", ["", "yes", "it's -5", "a=b", "5-4", "x@y", "'quoted'", "#1"])
def test_ordinary_text_is_unchanged(text: str) -> None:
    """Text is unchanged if it has a formula sign anywhere except at its start."""
    assert safe_text(text) == text


def test_a_formula_in_an_answer_is_escaped() -> None:
    """A formula typed as an answer is exported as text with a leading apostrophe."""
    row = _read(_written(value_text='=HYPERLINK("http://x","y")'))
    assert row["value_text"] == '\'=HYPERLINK("http://x","y")'


def test_a_negative_number_stays_a_number() -> None:
    """A negative number in a numeric column gets no apostrophe."""
    row = _read(_written(value_number=-5))
    assert float(row["value_number"]) == -5.0


def test_numbers_are_written_in_full() -> None:
    """A number is written with enough digits to be read back exactly."""
    assert float(_read(_written(value_number=0.1 + 0.2))["value_number"]) == 0.1 + 0.2


def test_missing_values_are_empty_and_booleans_are_words() -> None:
    """A missing value is an empty cell, and booleans are `true` and `false`."""
    row = _read(_written())
    assert (row["value_number"], row["value_text"], row["block"], row["submitted_at_utc"]) == (
        ("",) * 4
    )
    assert (row["simulated"], row["valid"]) == ("false", "true")


def test_lines_end_with_lf_and_texts_are_quoted() -> None:
    """Lines end with LF, and texts with quotes, commas or line breaks are quoted (RFC 4180)."""
    text = 'one "two", three\nfour; fünf'
    written = _written(value_text=text)
    assert "\r" not in written
    assert '"one ""two"", three\nfour; fünf"' in written
    assert _read(written)["value_text"] == text


def test_times_are_utc() -> None:
    """Times are written in UTC in ISO 8601 with a Z."""
    row = _read(_written(submitted_at_utc=pd.Timestamp("2026-03-02T10:30:00.25+01:00")))
    assert row["submitted_at_utc"] == "2026-03-02T09:30:00.250000Z"
