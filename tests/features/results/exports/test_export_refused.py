"""Tests that an export does not touch foreign files, an earlier export or paths outside."""

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
def test_an_export_refuses_a_path_with_foreign_files(
    filled: Database, tmp_path: Path, what: str
) -> None:
    """An export to a foreign file, folder or link is refused and leaves it unchanged."""
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


def test_a_failed_export_keeps_the_earlier_one(
    filled: Database, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A failed export leaves an earlier one unchanged and no partial files."""
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
    """The file name made from a hostile participant code stays in the folder `samples`."""
    folder, _, name = samples_path(code, "f" * 32).partition("/")
    assert folder == "samples"
    assert set(name) <= set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.")
    assert name.count(".") == 1
    assert not name.startswith(("-", "."))


def test_a_hostile_study_key_cannot_break_the_header() -> None:
    """The archive's name made from a hostile study key has no quote, line break or slash."""
    assert archive_name('x"\r\nset-cookie: a=b/..', "people", NOW.date()) == (
        "reembody_x___set-cookie__a_b____people_2026-03-02.zip"
    )


def test_a_hostile_code_in_the_database_stays_inside(database: Database, tmp_path: Path) -> None:
    """A hostile participant code in the database cannot make an export write outside its folder."""
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
    """Exporting an unknown study creates no folder."""
    with database.reading() as db, pytest.raises(NotFound):
        export_study(db, "../x", "people", tmp_path / "out", now=NOW)
    assert not (tmp_path / "out").exists()
