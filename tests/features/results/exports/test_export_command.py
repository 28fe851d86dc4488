"""Exporting from the command line."""

from pathlib import Path

import pytest

from app.cli.progress import Activity
from app.cli.record import export_to_folder
from app.database import open_database
from app.errors import NotFound
from tests.features.builders import STUDY, SessionSpec, build_session, build_study


@pytest.fixture
def installation(database_url: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The environment of a machine whose database has one simulated session."""
    monkeypatch.setenv("REEMBODY_DATABASE_URL", database_url)
    database = open_database(database_url)
    with database.writing() as db:
        build_study(db)
        build_session(db, SessionSpec("SIM-0001", kind="simulated"))
    database.close()


@pytest.mark.usefixtures("installation")
def test_the_command_writes_a_folder_and_says_what(tmp_path: Path) -> None:
    """Without a kind it takes what there is, and names it."""
    said = export_to_folder(STUDY, tmp_path / "out", Activity(""))
    files = sum(path.is_file() for path in (tmp_path / "out").rglob("*"))
    counts, head = said.splitlines()
    assert counts == f"1 session(s) of kind simulated in {files} files: {tmp_path / 'out'}"
    assert head.startswith("audit head ")
    assert head.removeprefix("audit head ") in (tmp_path / "out" / "README.txt").read_text()


@pytest.mark.one_engine
@pytest.mark.usefixtures("installation")
def test_the_command_refuses_what_it_does_not_know(tmp_path: Path) -> None:
    """An unknown kind and an unknown study are told apart, and nothing is written."""
    with pytest.raises(ValueError, match="valid are people, simulated, test, all"):
        export_to_folder(STUDY, tmp_path / "out", Activity(""), kind="robots")
    with pytest.raises(NotFound):
        export_to_folder("nothing", tmp_path / "out", Activity(""))
    assert not (tmp_path / "out").exists()
