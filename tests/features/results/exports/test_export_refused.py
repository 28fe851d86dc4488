"""What an export does not touch: other people's files, an earlier export, what lies outside."""

from collections.abc import Iterator
from pathlib import Path

import pytest

from app.database import Database
from app.errors import Conflict, NotFound
from app.features.results.exports.names import archive_name, samples_path
from app.features.results.exports.writing.samples import SampleFile
from app.features.results.exports.writing.service import export_study
from tests.faults.figures import note
from tests.features.builders import NOW, SessionSpec, build_session
from tests.features.results.exports.whole import export, tree_of

pytestmark = pytest.mark.one_engine


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
            export(filled, out)
        out.mkdir(exist_ok=True)
        (out / "analysis.R").write_text("mine")
    before = sorted(path for path in tmp_path.rglob("*"))
    with pytest.raises(Conflict) as refusal:
        export(filled, out)
    assert str(out) in refusal.value.message
    assert refusal.value.remedy
    assert sorted(path for path in tmp_path.rglob("*")) == before


def test_a_failed_export_leaves_what_was_there(
    filled: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The earlier export stands untouched, and no half of the new one is left."""
    export(filled, tmp_path / "out")
    before = tree_of(tmp_path / "out")

    def fails(*_: object) -> Iterator[bytes]:
        yield b"half a line"
        raise OSError("the disk is full")

    monkeypatch.setattr(SampleFile, "pieces", fails)
    for to in (tmp_path / "out", tmp_path / "fresh"):
        with pytest.raises(OSError, match="the disk is full"):
            export(filled, to)
    assert tree_of(tmp_path / "out") == before
    assert not (tmp_path / "fresh").exists()
    assert not list(tmp_path.glob(".*"))


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
    assert archive_name('x"\r\nset-cookie: a=b/..', "people", NOW.date()) == (
        "reembody_x___set-cookie__a_b____people_2026-03-02.zip"
    )


def test_a_hostile_code_in_the_database_stays_inside(database: Database, tmp_path: Path) -> None:
    """Even if such a code got into the database, its file is written into samples/."""
    with database.writing() as db:
        build_session(db, SessionSpec("../../../escape", kind="test"))
    export(database, tmp_path / "out", kind="test")
    names = [name for name in tree_of(tmp_path / "out") if name.startswith("samples/")]
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
