"""Tests that docs/glossary.md has one entry per word, and that the code and CSV names exist."""

import re
from functools import cache

import pytest

from app.features.results.analysis.codebook import CODEBOOK, TABLES
from tests.docs.markdown import DOCS, REPOSITORY

GLOSSARY = DOCS / "glossary.md"
HEAD = "| word | German | meaning | in code | in CSV |"
SPAN = re.compile(r"`([^`]+)`")
SOURCES = {"app": ("*.py",), "frontend/src": ("*.ts", "*.tsx")}


def entries() -> list[list[str]]:
    """Return the cells of every row in the glossary's tables."""
    rows: list[list[str]] = []
    inside = False
    for line in GLOSSARY.read_text(encoding="utf-8").splitlines():
        inside = line == HEAD or (inside and line.startswith("|"))
        if inside and line != HEAD and not line.startswith("|---"):
            rows.append([cell.strip() for cell in line.strip("|").split(" |")])
    return rows


@cache
def code() -> str:
    """Return the source code of the server and the pages."""
    return "\n".join(
        path.read_text(encoding="utf-8")
        for folder, patterns in SOURCES.items()
        for pattern in patterns
        for path in sorted((REPOSITORY / folder).rglob(pattern))
        if "static" not in path.parts
    )


def test_every_word_has_one_entry_in_both_languages() -> None:
    """Every word of the glossary has one complete entry with its German translation."""
    words = [row[0] for row in entries()]
    assert len(words) > 60
    assert [row for row in entries() if len(row) != 5 or not all(row[:4])] == []
    assert sorted({word for word in words if words.count(word) > 1}) == []


@pytest.mark.parametrize("row", entries(), ids=lambda row: row[0])
def test_the_glossarys_names_exist_in_the_code(row: list[str]) -> None:
    """Every path and name that the glossary gives for the code exists there."""
    for name in SPAN.findall(row[3]):
        if "/" in name:
            assert (REPOSITORY / name).exists(), f"{row[0]}: {name} does not exist"
        else:
            assert re.search(rf"\b{re.escape(name)}\b", code()), f"{row[0]}: no source says {name}"


def test_the_glossarys_names_exist_in_the_csv() -> None:
    """Every name that the glossary gives for CSV is a table or column of the export."""
    there = {*TABLES, *(column.name for column in CODEBOOK)}
    named = {name for row in entries() for name in SPAN.findall(row[4])}
    assert len(named) > 30
    assert sorted(named - there) == []


def test_every_table_of_the_export_is_a_word_of_the_glossary() -> None:
    """Every table of the export, except for parts of others, is named in the glossary."""
    parts = {"joint_error_course", "clock_mapping", "calibrations"}
    named = {name for row in entries() for name in SPAN.findall(row[4])}
    assert sorted(set(TABLES) - named - parts) == []


def test_older_words_are_still_used() -> None:
    """Every word in the glossary's list of older words is still used in the code."""
    text = GLOSSARY.read_text(encoding="utf-8").partition("## Older words that stay")[2]
    rows = [line.strip("|").split(" |")[0] for line in text.splitlines() if line.startswith("| `")]
    words = [word for row in rows for word in SPAN.findall(row)]
    assert len(words) > 8
    assert [word for word in words if not re.search(rf"\b{word}\b", code())] == []
