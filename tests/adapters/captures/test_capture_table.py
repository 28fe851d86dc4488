"""The table of formats and files in the documents is what the code does."""

from pathlib import Path

from app.adapters.captures import FORMATS
from tests.support.capture_table import PAGE, files, rows


def test_every_shared_file_fares_as_the_table_says(shared_data: Path) -> None:
    """Each loads, or is refused, with the numbers and the reason that the document names."""
    told = [
        line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("| `")
    ]
    assert told == [row.line for row in rows(shared_data)]
    assert len(files(shared_data)) > 60


def test_every_format_is_described() -> None:
    """A format that can be read is in the document."""
    text = PAGE.read_text(encoding="utf-8")
    for known in FORMATS:
        assert f"| {known.title} | " in text
