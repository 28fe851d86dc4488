"""Tests that the documentation's table of formats and files agrees with the code."""

from pathlib import Path

from app.adapters.captures import FORMATS
from tests.support.capture_table import PAGE, files, rows


def test_every_shared_file_reads_as_documented(shared_data: Path) -> None:
    """Each shared file loads with the documented numbers or raises an error with the reason."""
    documented = [
        line for line in PAGE.read_text(encoding="utf-8").splitlines() if line.startswith("| `")
    ]
    assert documented == [row.line for row in rows(shared_data)]
    assert len(files(shared_data)) > 60


def test_every_format_is_described() -> None:
    """Every format that can be read is in the documentation."""
    text = PAGE.read_text(encoding="utf-8")
    for capture_format in FORMATS:
        assert f"| {capture_format.title} | " in text
