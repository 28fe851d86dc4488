"""Files that are no table, or not quite: told in the words of whoever chose them."""

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
def test_another_kind_of_file_is_named(text: str, named: str) -> None:
    """A picture is called a picture, and not a line with a comma that was expected."""
    with pytest.raises(InvalidInput) as refused:
        read_sheet(text)
    assert named in refused.value.message
    assert "CSV" in refused.value.remedy


def test_a_wrong_quote_is_named_with_its_line() -> None:
    """The line, what is wrong there and what to do, in words."""
    with pytest.raises(InvalidInput) as refused:
        read_sheet('code,q1\nP-1,"4"x\n')
    assert refused.value.message.startswith("line 2 cannot be read: a quote is")
    assert "expected" not in refused.value.message
