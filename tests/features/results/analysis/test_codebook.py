"""Tests that every exported column is described exactly once."""

from collections import Counter
from pathlib import Path

from app.features.results.analysis.codebook import CODEBOOK, TABLES, codebook_frame, data_dictionary
from app.science.skeleton import JOINT_NAMES

PAGE = Path(__file__).resolve().parents[4] / "docs" / "data-dictionary.md"


def test_a_column_has_exactly_one_entry() -> None:
    """Every column of every table has exactly one entry in the codebook."""
    counts = Counter((column.table, column.name) for column in CODEBOOK)
    assert set(counts.values()) == {1}
    assert {table for table, _ in counts} == set(TABLES)


def test_every_entry_has_a_meaning_and_a_type() -> None:
    """Every entry of the codebook has a meaning, as a sentence, and a known type."""
    for column in CODEBOOK:
        assert column.meaning.endswith(".")
        assert column.type in ("text", "integer", "number", "boolean", "time")


def test_column_names_end_with_their_unit() -> None:
    """A column in degrees, metres, seconds, milliseconds or m/s has the unit as its suffix."""
    suffixes = {"_deg": "deg", "_m": "m", "_m_s": "m/s", "_s": "s", "_ms": "ms"}
    for column in CODEBOOK:
        longest = max((one for one in suffixes if column.name.endswith(one)), key=len, default="")
        if column.type == "number" and longest:
            assert column.unit.split(",")[0] == suffixes[longest], column
        for suffix, unit in suffixes.items():
            if column.unit == unit:
                assert column.name.endswith(suffix), column
        assert (column.type == "time") == column.name.endswith("_utc")


def test_every_table_of_data_says_whether_it_was_simulated() -> None:
    """Every table of session data has the columns `simulated` and `avatar`."""
    for table in set(TABLES) - {"codebook", "wide_columns", "calibrations", "headset_tests"}:
        names = {column.name for column in CODEBOOK if column.table == table}
        assert {"simulated", "avatar"} <= names


def test_both_streams_have_columns_for_root_and_quaternions() -> None:
    """The table of samples has 3 + 4 x 22 columns for each stream."""
    names = [column.name for column in CODEBOOK if column.table == "samples"]
    for stream in ("target", "actual"):
        assert f"{stream}_root_x_m" in names
        assert f"{stream}_{JOINT_NAMES[-1]}_qz" in names
        assert sum(name.startswith(f"{stream}_") for name in names) == 3 + 4 * 22


def test_the_page_is_the_codebook() -> None:
    """docs/data-dictionary.md is up to date with the codebook."""
    assert PAGE.read_text(encoding="utf-8") == data_dictionary()


def test_the_codebook_describes_itself() -> None:
    """The codebook has an entry for each of its own columns."""
    frame = codebook_frame()
    own = frame[frame["table"] == "codebook"]["column"].tolist()
    assert own == list(frame.columns)
