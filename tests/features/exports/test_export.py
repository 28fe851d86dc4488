"""A whole export: as a folder, as an archive, and refused."""

import csv
import hashlib
import io
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from sqlalchemy.orm import Session

from app.database import Database
from app.errors import Conflict, NotFound
from app.features.analysis.codebook import CODEBOOK, columns_of
from app.features.exports.names import archive_name, samples_path
from app.features.exports.samples import SampleFile
from app.features.exports.service import Exported, export_study, study_archive, usual_kind
from app.wire import StreamName
from tests.faults.figures import note
from tests.features.builders import NOW, STUDY, SessionSpec, build_session
from tests.features.movement_builders import moving_values, store_chunks

TABLES = ("sessions", "phases", "answers", "scores", "contacts", "completions", "joint_errors")
MORE = (
    "corrections",
    "events",
    "quality",
    "alarms",
    "clock_probes",
    "clock_mapping",
    "calibrations",
    "codebook",
)
FILES = {*(f"{name}.csv" for name in (*TABLES, *MORE)), "README.txt"}


@pytest.fixture
def filled(database: Database) -> Database:
    """Two people and one simulated session, one person with movement."""
    with database.writing() as db:
        first = build_session(db, SessionSpec("P-0001", open_answer='=HYPERLINK("http://x","y")'))
        build_session(db, SessionSpec("P-0002", status="withdrawn"))
        build_session(db, SessionSpec("SIM-0001", kind="simulated"))
        for seed, stream in enumerate(StreamName):
            store_chunks(db, first.id, stream, range(200), moving_values(200, seed))
    return database


def _export(database: Database, to: Path, **options: Any) -> Exported:
    with database.reading() as db:
        return export_study(db, STUDY, options.pop("kind", "people"), to, now=NOW, **options)


def _tree(folder: Path) -> dict[str, bytes]:
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in folder.rglob("*")
        if path.is_file()
    }


def _rows(data: bytes) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(data.decode(), newline="")))


def test_an_export_has_every_file(filled: Database, tmp_path: Path) -> None:
    """The tables, the codebook, the README, and frames and a receipt for each session."""
    done = _export(filled, tmp_path / "out")
    tree = _tree(tmp_path / "out")
    samples = {name for name in tree if name.startswith("samples/")}
    receipts = {name for name in tree if name.startswith("receipts/")}
    assert set(tree) - samples - receipts == FILES
    assert len(samples) == len(receipts) == done.sessions == 2
    assert done.files == len(tree)


def test_every_column_of_every_file_is_in_the_codebook(filled: Database, tmp_path: Path) -> None:
    """Headers and entries are the same, in the same order."""
    _export(filled, tmp_path / "out")
    for name, data in _tree(tmp_path / "out").items():
        if name.endswith(".csv"):
            table = "samples" if name.startswith("samples/") else name.removesuffix(".csv")
            header = data.decode().partition("\n")[0].split(",")
            assert header == [column.name for column in columns_of(table)]
    assert len(_rows((tmp_path / "out" / "codebook.csv").read_bytes())) == len(CODEBOOK)


def test_kinds_stay_apart_in_files(filled: Database, tmp_path: Path) -> None:
    """People's export holds no simulated row, and the reverse."""
    for kind, other in (("people", "simulated"), ("simulated", "people")):
        _export(filled, tmp_path / kind, kind=kind)
        for name in (*TABLES, "events"):
            rows = _rows((tmp_path / kind / f"{name}.csv").read_bytes())
            assert {row["kind"] for row in rows} == {kind}
            assert other not in {row["kind"] for row in rows}


def test_the_readme_says_where_it_comes_from(filled: Database, tmp_path: Path) -> None:
    """Kind, time, study, content hash, counts, and a hash of each file that holds."""
    _export(filled, tmp_path / "out", kind="simulated")
    tree = _tree(tmp_path / "out")
    readme = tree["README.txt"].decode()
    for words in (STUDY, "2026-03-02T09:30:00Z", "simulated", "1 completed", "by a simulation"):
        assert words in readme
    assert _rows(tree["sessions.csv"])[0]["study_content_hash"] in readme
    for name, data in tree.items():
        if name != "README.txt":
            assert f"{hashlib.sha256(data).hexdigest()}" in readme


def test_the_archive_holds_the_same_files(filled: Database, tmp_path: Path) -> None:
    """Folder and ZIP agree byte for byte."""
    _export(filled, tmp_path / "out")
    data = b"".join(study_archive(filled, STUDY, "people", now=NOW))
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        assert archive.testzip() is None
        assert {name: archive.read(name) for name in archive.namelist()} == _tree(tmp_path / "out")


def test_two_exports_of_the_same_data_are_the_same(filled: Database, tmp_path: Path) -> None:
    """Nothing depends on when or where, but the time in the README that is given."""
    _export(filled, tmp_path / "one")
    _export(filled, tmp_path / "two")
    assert _tree(tmp_path / "one") == _tree(tmp_path / "two")


def test_a_formula_in_the_open_prompt_is_inert(filled: Database, tmp_path: Path) -> None:
    """No cell of any file begins with what a spreadsheet runs, but numbers."""
    _export(filled, tmp_path / "out")
    cells = [
        cell
        for name in FILES - {"README.txt"}
        for row in _rows((tmp_path / "out" / name).read_bytes())
        for cell in row.values()
    ]
    assert '\'=HYPERLINK("http://x","y")' in cells
    live = [cell for cell in cells if cell.startswith(("=", "+", "-", "@"))]
    assert all(float(cell) < 0 for cell in live)


def test_an_earlier_export_is_replaced(filled: Database, tmp_path: Path) -> None:
    """Its files are gone, also those that the new one does not have."""
    _export(filled, tmp_path / "out")
    _export(filled, tmp_path / "out", kind="simulated")
    assert len(list((tmp_path / "out" / "samples").iterdir())) == 1
    assert not list(tmp_path.glob(".*"))


@pytest.mark.parametrize("what", ["other folder", "file", "own file in an export", "link"])
def test_what_is_not_ours_is_refused_and_left_alone(
    filled: Database, tmp_path: Path, what: str
) -> None:
    """Nothing is written, nothing removed, and the error says why."""
    out, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    if what == "file":
        out.write_text("mine")
    elif what == "link":
        elsewhere.mkdir()
        out.symlink_to(elsewhere)
    else:
        if what == "own file in an export":
            _export(filled, out)
        out.mkdir(exist_ok=True)
        (out / "analysis.R").write_text("mine")
    before = sorted(path for path in tmp_path.rglob("*"))
    with pytest.raises(Conflict) as refusal:
        _export(filled, out)
    assert str(out) in refusal.value.message
    assert refusal.value.remedy
    assert sorted(path for path in tmp_path.rglob("*")) == before


def test_a_failed_export_leaves_what_was_there(
    filled: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The earlier export stands untouched, and no half of the new one is left."""
    _export(filled, tmp_path / "out")
    before = _tree(tmp_path / "out")

    def fails(*_: object) -> Iterator[bytes]:
        yield b"half a line"
        raise OSError("the disk is full")

    monkeypatch.setattr(SampleFile, "pieces", fails)
    for to in (tmp_path / "out", tmp_path / "fresh"):
        with pytest.raises(OSError, match="the disk is full"):
            _export(filled, to)
    assert _tree(tmp_path / "out") == before
    assert not (tmp_path / "fresh").exists()
    assert not list(tmp_path.glob(".*"))


def test_progress_tells_each_file(filled: Database, tmp_path: Path) -> None:
    """Every path once, as it is begun, the README last."""
    told: list[str] = []
    _export(filled, tmp_path / "out", progress=told.append)
    assert set(told) == set(_tree(tmp_path / "out"))
    assert told[-1] == "README.txt"


@pytest.mark.parametrize("code", ["../../etc/passwd", "/etc/passwd", "a\\..\\b", "-rf", "", "é\0"])
def test_a_hostile_code_cannot_leave_the_folder(code: str) -> None:
    """File names are made of letters, digits, - and _ only."""
    folder, _, name = samples_path(code, "f" * 32).partition("/")
    assert folder == "samples"
    assert set(name) <= set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.")
    assert name.count(".") == 1
    assert not name.startswith(("-", "."))


def test_a_hostile_study_key_cannot_break_the_header() -> None:
    """No quotation mark, line break or slash comes into the name of the archive."""
    assert archive_name('x"\r\nset-cookie: a=b/..', "people") == (
        "reembody_x___set-cookie__a_b____people.zip"
    )


def test_a_hostile_code_in_the_database_stays_inside(filled: Database, tmp_path: Path) -> None:
    """Even if such a code got into the database, its file is written into samples/."""
    with filled.writing() as db:
        build_session(db, SessionSpec("../../../escape", kind="test"))
    _export(filled, tmp_path / "out", kind="test")
    names = [name for name in _tree(tmp_path / "out") if name.startswith("samples/")]
    assert len(names) == 1
    assert names[0].startswith("samples/_________escape_")
    escaped = [*tmp_path.parent.glob("*escape*"), *tmp_path.glob("*escape*")]
    note(34, "paths in names of an export", "escapes", len(escaped))
    assert escaped == []


def test_an_unknown_study_leaves_no_folder(database: Database, tmp_path: Path) -> None:
    """The error names the studies there are."""
    with database.reading() as db, pytest.raises(NotFound):
        export_study(db, "../x", "people", tmp_path / "out", now=NOW)
    assert not (tmp_path / "out").exists()


def _kind_of(db: Session, *specs: SessionSpec) -> str:
    for spec in specs:
        build_session(db, spec)
    return usual_kind(db, STUDY)


def test_without_a_kind_people_come_first(database: Database) -> None:
    """A study without people gives what it has; people are never joined by others."""
    with database.writing() as db:
        assert usual_kind(db, STUDY) == "people"
        assert _kind_of(db, SessionSpec("T", kind="test")) == "test"
        assert _kind_of(db, SessionSpec("S", kind="simulated")) == "simulated"
        assert _kind_of(db, SessionSpec("P")) == "people"
