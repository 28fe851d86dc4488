"""Tests that a file which is not a valid table is rejected with a clear description."""

import pytest

from app.errors import InvalidInput
from app.features.results.imports.sheet import read_sheet


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("\u2030PNG\r\n\x1a\n" + "x" * 50, "a picture"),
        ("\xff\xd8\xff\xe0JFIF", "a picture"),
        ("%PDF-1.7\n%....", "a PDF"),
        ("PK\x03\x04\x14abc", "a workbook"),
        ("code,q1\nP-1,\x024\n", "not a text file"),
    ],
)
def test_another_kind_of_file_is_refused_by_its_kind(text: str, named: str) -> None:
    """A picture, PDF, workbook or binary file is refused with its kind and a hint to use CSV."""
    with pytest.raises(InvalidInput) as refused:
        read_sheet(text)
    assert named in refused.value.message
    assert "CSV" in refused.value.remedy


def test_a_misplaced_quote_is_reported_with_its_line() -> None:
    """A misplaced quote is reported with its line number."""
    with pytest.raises(InvalidInput) as refused:
        read_sheet('code,q1\nP-1,"4"x\n')
    assert refused.value.message.startswith("line 2 cannot be read: a quote is")
    assert "expected" not in refused.value.message
