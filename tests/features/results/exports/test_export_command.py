"""Tests of exporting from the command line."""

from pathlib import Path

import pytest

from app.cli.progress import Activity
from app.cli.record import export_to_folder
from app.database import open_database
from app.errors import NotFound
from tests.features.builders import STUDY, SessionSpec, build_session, build_study


@pytest.fixture
def installation(database_url: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Configure a database with one simulated session through the environment."""
    monkeypatch.setenv("REEMBODY_DATABASE_URL", database_url)
    database = open_database(database_url)
    with database.writing() as db:
        build_study(db)
        build_session(db, SessionSpec("SIM-0001", kind="simulated"))
    database.close()


@pytest.mark.usefixtures("installation")
def test_the_command_writes_a_folder_and_reports_its_content(tmp_path: Path) -> None:
    """The export command uses the default kind and reports kind, counts, folder and audit head."""
    output = export_to_folder(STUDY, tmp_path / "out", Activity(""))
    files = sum(path.is_file() for path in (tmp_path / "out").rglob("*"))
    counts, head = output.splitlines()
    assert counts == f"1 session(s) of kind simulated in {files} files: {tmp_path / 'out'}"
    assert head.startswith("audit head ")
    assert head.removeprefix("audit head ") in (tmp_path / "out" / "README.txt").read_text()


@pytest.mark.one_engine
@pytest.mark.usefixtures("installation")
def test_the_command_refuses_an_unknown_kind_or_study(tmp_path: Path) -> None:
    """The export command refuses an unknown kind or study and writes nothing."""
    with pytest.raises(ValueError, match="valid are people, simulated, test, all"):
        export_to_folder(STUDY, tmp_path / "out", Activity(""), kind="robots")
    with pytest.raises(NotFound):
        export_to_folder("nothing", tmp_path / "out", Activity(""))
    assert not (tmp_path / "out").exists()
