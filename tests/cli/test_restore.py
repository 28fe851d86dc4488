"""Tests of `reembody restore`: its output, its options and the files that it leaves."""

import json
import re
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest
from sqlalchemy import select

from app.cli import progress
from app.database import open_database
from app.errors import NotFound
from app.features.care.backups import back_up
from app.features.care.rights.tombstones import read_list
from app.models import Erasure, Participant
from tests.cli.invoked import Invoked
from tests.features.care.backups.lab import CLOCK
from tests.features.care.opening.files import UNDECODABLE, edited
from tests.features.lab import STUDY, Lab, ok, running_lab
from tests.support.sqlite import fresh_sqlite

pytestmark = pytest.mark.thorough

RESTORE = Invoked("restore")


@pytest.fixture(autouse=True)
def no_progress(monkeypatch: pytest.MonkeyPatch) -> None:
    """Turn off the output of progress, which a slow machine would mix with warnings."""
    monkeypatch.setattr(progress, "FIRST_UPDATE_S", 600.0)


@dataclass(frozen=True)
class Earlier:
    """A backup of an installation, one of whose participants was erased after it was made."""

    backup: Path
    erasures: Path
    code: str


@contextmanager
def lab_in(folder: Path) -> Iterator[Lab]:
    """Run an installation with its data in `folder`."""
    folder.mkdir()
    with running_lab(fresh_sqlite(folder / "reembody.sqlite"), data_dir=folder) as lab:
        yield lab


@pytest.fixture
def earlier(tmp_path: Path) -> Earlier:
    """Return an installation that was backed up and then erased a participant."""
    backup = tmp_path / "all.reembody"
    with lab_in(tmp_path / "earlier") as lab:
        session = lab.join(kind="people", participant_code="CANARY-1")
        lab.command(lab.command(session, "start"), "withdraw", reason="enough")
        back_up(lab.database, backup, clock=CLOCK)
        with lab.database.reading() as db:
            participant_id = db.scalar(select(Participant.id))
        ok(
            lab.operator.post(
                f"/api/studies/{STUDY}/participants/{participant_id}/erasure",
                json={"confirm": "CANARY-1", "reason_code": "requested"},
            )
        )
    return Earlier(backup, tmp_path / "earlier" / "erasures.jsonl", "CANARY-1")


@pytest.fixture
def data(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Return the missing data folder of a new installation, set in the environment."""
    monkeypatch.setenv("REEMBODY_DATA_DIR", str(tmp_path / "new"))
    return tmp_path / "new"


def codes(data: Path) -> list[str]:
    """Return the codes of all participants."""
    database = open_database(f"sqlite:///{data / 'reembody.sqlite'}")
    with database.reading() as db:
        found = list(db.scalars(select(Participant.code)))
    database.close()
    return found


def test_a_path_that_is_not_a_file_is_described(data: Path, tmp_path: Path) -> None:
    """A folder, device or dangling link given as a backup or list of erasures is described."""
    (tmp_path / "away").symlink_to(tmp_path / "gone")
    expected = {
        Path("/dev/zero"): "/dev/zero is not a regular file",
        tmp_path: f"{tmp_path} is a folder, where a file is needed",
        tmp_path / "away": "is a link that leads to no file",
        tmp_path / "missing": "there is no file missing in",
    }
    for path, words in expected.items():
        assert words in RESTORE.refusal(path)
        with pytest.raises(NotFound, match=re.escape(words)):
            read_list(path)
    assert not data.exists()


@pytest.mark.parametrize("head", ["15:zz", "15:ab", "x"])
def test_an_invalid_head_is_refused_before_the_database_is_opened(
    head: str, data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """An invalid head is refused before the database is opened and without creating a folder."""
    monkeypatch.setattr(progress, "FIRST_UPDATE_S", 0.0)
    output = Invoked("verify").refusal("--head", head)
    assert "is not the head of an audit trail" in output
    assert "opening" not in output
    assert not data.exists()


def test_a_restore_without_a_list_of_erasures_warns(earlier: Earlier, data: Path) -> None:
    """A restore without a list of erasures warns, and can be repeated with the list."""
    result = RESTORE.run(earlier.backup)
    assert result.exit_code == 0
    assert "has no list of erasures" in result.stderr
    assert "--erasures FILE" in result.stderr
    assert codes(data) == [earlier.code]
    reply = RESTORE.figures(earlier.backup, "--replace", "--erasures", earlier.erasures)
    assert reply["erasures_reapplied"] == 1
    assert earlier.code not in codes(data)
    assert (data / "erasures.jsonl").read_text() == earlier.erasures.read_text()


def test_a_restore_with_a_list_of_erasures_reapplies_them(earlier: Earlier, data: Path) -> None:
    """A restore with a list of erasures, given or in the data folder, reapplies them silently."""
    result = RESTORE.run(earlier.backup, "--erasures", earlier.erasures, "--json")
    assert (result.exit_code, result.stderr) == (0, "")
    assert earlier.code not in codes(data)
    shutil.rmtree(data)
    data.mkdir()
    shutil.copyfile(earlier.erasures, data / "erasures.jsonl")
    result = RESTORE.run(earlier.backup)
    assert (result.exit_code, result.stderr) == (0, "")
    assert earlier.code not in codes(data)


def test_erasures_of_unknown_participants_are_kept(
    earlier: Earlier, data: Path, tmp_path: Path
) -> None:
    """Erasures of participants who are not in a backup are kept for the next restore."""
    with lab_in(tmp_path / "other") as lab:
        lab.join(kind="people", participant_code="P-1")
        back_up(lab.database, tmp_path / "other.reembody", clock=CLOCK)
    assert RESTORE.run(tmp_path / "other.reembody", "--erasures", earlier.erasures).exit_code == 0
    assert RESTORE.run(earlier.backup, "--replace").exit_code == 0
    database = open_database(f"sqlite:///{data / 'reembody.sqlite'}")
    with database.reading() as db:
        assert db.scalar(select(Erasure.id)) is not None
    database.close()


@pytest.mark.parametrize("line", ["{}", "not JSON", '{"erasure_id": "x"}', "\udcff"])
def test_an_invalid_list_of_erasures_is_refused(earlier: Earlier, data: Path, line: str) -> None:
    """An invalid list of erasures is refused before anything is changed."""
    text = earlier.erasures.read_text() + line + "\n"
    earlier.erasures.write_text(text, errors="surrogateescape")
    assert "are not erasures" in RESTORE.refusal(earlier.backup, "--erasures", earlier.erasures)
    assert not data.exists()


def test_a_backup_without_people_is_restored_without_a_warning(data: Path, tmp_path: Path) -> None:
    """A backup without participants is restored without a warning about erasures."""
    with lab_in(tmp_path / "earlier") as lab:
        lab.join(kind="simulated")
        back_up(lab.database, tmp_path / "all.reembody", clock=CLOCK)
    result = RESTORE.run(tmp_path / "all.reembody")
    assert (result.exit_code, result.stderr) == (0, "")
    assert data.is_dir()


def test_a_restore_that_fails_leaves_nothing(
    earlier: Earlier, data: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A restore into a missing data folder that fails leaves no files or folders."""

    def fail(*_: object) -> int:
        raise OSError(5, "Input/output error")

    monkeypatch.setattr("app.features.care.backups.service._unpair_headsets", fail)
    assert "Input/output error" in RESTORE.refusal(earlier.backup, "--erasures", earlier.erasures)
    assert not data.exists()


@pytest.mark.parametrize("replace", [(), ("--replace",)])
def test_a_restore_quarantines_a_damaged_database(
    earlier: Earlier, data: Path, replace: tuple[str, ...]
) -> None:
    """A restore over a damaged database quarantines it and continues."""
    assert RESTORE.run(earlier.backup, "--erasures", earlier.erasures).exit_code == 0
    file = data / "reembody.sqlite"
    edited(file, UNDECODABLE)
    damaged = file.read_bytes()
    result = RESTORE.run(earlier.backup, *replace, "--json")
    assert result.exit_code == 0, result.output
    assert "is damaged" in result.stderr
    assert json.loads(result.stdout)["before"] is None
    (kept,) = (data / "quarantine").glob("*/reembody.sqlite")
    assert kept.read_bytes() == damaged


def test_files_made_by_commands_are_private(earlier: Earlier, data: Path) -> None:
    """Every file and folder that restore, backup and export create is private to its owner."""
    assert RESTORE.run(earlier.backup, "--erasures", earlier.erasures).exit_code == 0
    assert Invoked("backup").run(data.parent / "again.reembody").exit_code == 0
    export = Invoked("export").run("--study", STUDY, "--to", data.parent / "export")
    assert export.exit_code == 0, export.output
    made = [data, *data.rglob("*"), data.parent / "again.reembody", data.parent / "export"]
    made += (data.parent / "export").rglob("*")
    assert {oct(path.stat().st_mode & 0o077) for path in made} == {"0o0"}
