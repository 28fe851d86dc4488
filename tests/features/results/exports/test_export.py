"""Tests of a whole export: as a folder, as an archive, and by kind of session."""

import hashlib
import io
import zipfile
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml
from sqlalchemy.orm import Session

from app.database import Database
from app.features.results.analysis.codebook import CODEBOOK, columns_of
from app.features.results.exports.writing.service import Exported, study_archive, usual_kind
from tests.features.builders import NOW, STUDY, SessionSpec, build_session
from tests.features.results.exports.whole import FILES, TABLES, export, rows_of, tree_of


@dataclass(frozen=True)
class Made:
    """An export that was made once for several tests, and the progress that was reported."""

    done: Exported
    progress: list[str]
    tree: dict[str, bytes]


@pytest.fixture(scope="module")
def people(filled: Database, tmp_path_factory: pytest.TempPathFactory) -> Made:
    """Return the export of people's sessions."""
    return made(filled, "people", tmp_path_factory)


@pytest.fixture(scope="module")
def simulated(filled: Database, tmp_path_factory: pytest.TempPathFactory) -> Made:
    """Return the export of simulated sessions."""
    return made(filled, "simulated", tmp_path_factory)


def made(filled: Database, kind: str, tmp_path_factory: pytest.TempPathFactory) -> Made:
    """Export the sessions of a kind, recording the reported progress."""
    progress: list[str] = []
    out = tmp_path_factory.mktemp("exported") / "out"
    return Made(export(filled, out, kind=kind, progress=progress.append), progress, tree_of(out))


def test_an_export_has_every_file(people: Made) -> None:
    """An export has all tables, codebook and README, and samples and a receipt for each session."""
    done, tree = people.done, people.tree
    samples = {name for name in tree if name.startswith("samples/")}
    receipts = {name for name in tree if name.startswith("receipts/")}
    protocol = {name for name in tree if name.startswith("protocol/")}
    assert set(tree) - samples - receipts - protocol == FILES
    assert len(samples) == len(receipts) == done.sessions == 2
    assert done.files == len(tree)


def test_an_export_says_what_was_asked_and_how_it_was_scored(people: Made) -> None:
    """Study and instruments travel along: every answered item and every score is explained."""
    texts = [data for name, data in people.tree.items() if name.startswith("protocol/")]
    files = [yaml.safe_load(text) for text in texts]
    asked = {item["key"]: item["text"] for file in files for item in file.get("items", ())}
    answered = {row["item"] for row in rows_of(people.tree["answers.csv"])}
    assert answered <= asked.keys()
    scored = {score["key"] for file in files for score in file.get("scores", ())}
    assert {row["score"] for row in rows_of(people.tree["scores.csv"])} <= scored
    assert [file["key"] for file in files if "conditions" in file] == [STUDY]


def test_every_column_of_every_file_is_in_the_codebook(people: Made) -> None:
    """The header of every CSV file is that table's columns in the codebook, in order.

    The columns of values in wide.csv depend on the study: wide_columns.csv has a row for each.
    """
    values = [row["name"] for row in rows_of(people.tree["wide_columns.csv"])]
    assert values
    for name, data in people.tree.items():
        if name.endswith(".csv"):
            table = "samples" if name.startswith("samples/") else name.removesuffix(".csv")
            header = data.decode().partition("\n")[0].split(",")
            described = [column.name for column in columns_of(table)]
            assert header == (described + values if table == "wide" else described)
    assert len(rows_of(people.tree["codebook.csv"])) == len(CODEBOOK)


def test_kinds_stay_apart_in_files(people: Made, simulated: Made) -> None:
    """An export of one kind of session has no row of another kind."""
    for made, kind, other in (
        (people, "people", "simulated"),
        (simulated, "simulated", "people"),
    ):
        for name in (*TABLES, "events"):
            rows = rows_of(made.tree[f"{name}.csv"])
            assert {row["kind"] for row in rows} == {kind}
            assert other not in {row["kind"] for row in rows}


def test_the_readme_states_the_origin_of_the_export(simulated: Made) -> None:
    """The README states study, version, kind, time, counts and the hash of every file."""
    tree = simulated.tree
    readme = tree["README.txt"].decode()
    for words in (STUDY, "2026-03-02T09:30:00Z", "simulated", "1 completed", "from a simulation"):
        assert words in readme
    assert rows_of(tree["sessions.csv"])[0]["study_content_hash"] in readme
    for name, data in tree.items():
        if name != "README.txt":
            assert f"{hashlib.sha256(data).hexdigest()}" in readme


def test_the_archive_has_the_same_files_as_the_folder(filled: Database, people: Made) -> None:
    """The exported ZIP archive has the same files as the folder, byte for byte."""
    data = b"".join(study_archive(filled, STUDY, "people", now=NOW))
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        assert {name: archive.read(name) for name in archive.namelist()} == people.tree


def test_two_exports_of_the_same_data_are_the_same(
    filled: Database, people: Made, tmp_path: Path
) -> None:
    """Two exports of the same data at the same given time are identical."""
    export(filled, tmp_path / "two")
    assert people.tree == tree_of(tmp_path / "two")


def test_a_formula_in_the_open_prompt_is_inert(people: Made) -> None:
    """No cell of an export, except negative numbers, begins with a formula sign."""
    cells = [
        cell
        for name in FILES - {"README.txt"}
        for row in rows_of(people.tree[name])
        for cell in row.values()
    ]
    assert '\'=HYPERLINK("http://x","y")' in cells
    live = [cell for cell in cells if cell.startswith(("=", "+", "-", "@"))]
    assert all(float(cell) < 0 for cell in live)


@pytest.mark.one_engine
def test_an_earlier_export_is_replaced(filled: Database, tmp_path: Path) -> None:
    """An export replaces an earlier one completely."""
    export(filled, tmp_path / "out")
    export(filled, tmp_path / "out", kind="simulated")
    assert len(list((tmp_path / "out" / "samples").iterdir())) == 1
    assert not list(tmp_path.glob(".*"))


@pytest.mark.one_engine
def test_progress_reports_each_file(people: Made) -> None:
    """Progress is reported once for each file, with the README last."""
    assert set(people.progress) == set(people.tree)
    assert people.progress[-1] == "README.txt"


def _kind_of(db: Session, *specs: SessionSpec) -> str:
    for spec in specs:
        build_session(db, spec)
    return usual_kind(db, STUDY)


@pytest.mark.one_engine
def test_the_default_kind_is_people_if_there_are_any(database: Database) -> None:
    """The default kind is people if the study has any, else simulated, and otherwise test."""
    with database.writing() as db:
        assert usual_kind(db, STUDY) == "people"
        assert _kind_of(db, SessionSpec("T", kind="test")) == "test"
        assert _kind_of(db, SessionSpec("S", kind="simulated")) == "simulated"
        assert _kind_of(db, SessionSpec("P")) == "people"
