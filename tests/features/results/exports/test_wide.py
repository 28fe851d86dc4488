"""Tests of the wide table: what it holds, and names that statistics programs take."""

import csv
import io
import re
import zipfile
from collections.abc import Iterator

import pytest

from tests.features.builders import STUDY, SessionSpec, build_session, build_study
from tests.features.lab import Lab

NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]{0,63}")


@pytest.fixture
def tables(fresh_lab: Lab) -> Iterator[dict[str, str]]:
    """Provide the texts of an export of two people who count and one who withdrew."""
    with fresh_lab.database.writing() as db:
        build_study(db)
        for code in ("P-0001", "P-0002"):
            build_session(db, SessionSpec(code))
        build_session(db, SessionSpec("P-0003", status="withdrawn"))
        build_session(db, SessionSpec("SIM-0001", kind="simulated"))
    answer = fresh_lab.operator.get(f"/api/studies/{STUDY}/export", params={"kind": "people"})
    with zipfile.ZipFile(io.BytesIO(answer.content)) as archive:
        yield {
            name: archive.read(name).decode()
            for name in archive.namelist()
            if name.endswith(".csv") and "/" not in name
        }


def _rows(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text)))


def test_the_wide_table_has_a_row_per_participant_who_counts(tables: dict[str, str]) -> None:
    """Neither somebody who withdrew nor simulated people are in it; values are those of scores."""
    wide = _rows(tables["wide.csv"])
    assert [(row["participant_code"], row["simulated"]) for row in wide] == [
        ("P-0001", "false"),
        ("P-0002", "false"),
    ]
    (score,) = [
        row
        for row in _rows(tables["scores.csv"])
        if (row["participant_code"], row["score"], row["limb"], row["latency_ms"])
        == ("P-0001", "agency", "hand", "350.0")
    ]
    assert wide[0]["karas2020_agency_hand_350ms"] == score["value"]


def test_every_column_is_explained_and_has_a_name_that_spss_takes(tables: dict[str, str]) -> None:
    """Names are unique, begin with a letter and have at most 64 letters, digits and underscores."""
    names = tables["wide.csv"].splitlines()[0].split(",")
    assert len({name.lower() for name in names}) == len(names)
    assert all(NAME.fullmatch(name) for name in names)
    explained = {row["name"]: row for row in _rows(tables["wide_columns.csv"])}
    assert [name for name in names if name in explained] == names[5:]
    assert explained["contact_time_foot_0ms"]["unit"] == "s"
