"""Tests of notes about incomplete files outside of the database."""

import signal
import subprocess
import sys
from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.platform.incomplete_files import (
    Notes,
    incomplete_files,
    partial_folder,
    remove_leftovers,
    uploads_of,
)
from app.settings import Settings

NOW = datetime(2026, 11, 21, 6, 11, 8, tzinfo=UTC)
KILLED = """
import os, signal, sys
from datetime import UTC, datetime
from pathlib import Path
from app.platform.incomplete_files import Notes, partial_folder
from app.settings import Settings
notes = Notes.of(Settings(data_dir=Path(sys.argv[1])))
now = datetime(2026, 11, 21, 6, 11, 8, tzinfo=UTC)
to, study = Path(sys.argv[2]), sys.argv[3]
with partial_folder("export", to, now=now, notes=notes, study_key=study) as folder:
    (folder / "new").mkdir()
    (folder / "new" / "answers.csv").write_text("somebody's")
    os.kill(os.getpid(), signal.SIGKILL)
"""


@pytest.fixture
def settings(tmp_path: Path) -> Settings:
    """Return the settings of an installation in its own folder."""
    (tmp_path / "data").mkdir()
    (tmp_path / "out").mkdir()
    return Settings(data_dir=tmp_path / "data")


def killed(settings: Settings, to: Path) -> None:
    """Kill a process while it makes an export."""
    arguments = [sys.executable, "-c", KILLED, str(settings.data_dir), str(to), "pilot"]
    assert subprocess.run(arguments, check=False).returncode == -signal.SIGKILL


def test_a_file_in_progress_is_listed_and_not_removed(settings: Settings, tmp_path: Path) -> None:
    """A file that is being made is listed and not removed; afterwards nothing remains of it."""
    to = tmp_path / "out" / "export"
    notes = Notes.of(settings)
    with partial_folder("export", to, now=NOW, notes=notes, study_key="pilot") as folder:
        (one,) = incomplete_files(settings)
        assert (one.kind, one.path, one.to, one.since) == ("export", folder, to, NOW)
        assert (one.study_key, one.going_on) == ("pilot", True)
        assert remove_leftovers(settings, starting=True) == []
        assert folder.is_dir()
    assert incomplete_files(settings) == []
    assert list(notes.folder.iterdir()) == []
    assert list((tmp_path / "out").iterdir()) == []


def test_files_of_a_killed_process_are_listed_and_removed(
    settings: Settings, tmp_path: Path
) -> None:
    """Incomplete files of a killed process are listed and removed."""
    killed(settings, tmp_path / "out" / "export")
    (one,) = incomplete_files(settings)
    assert not one.going_on
    assert (one.path / "new" / "answers.csv").is_file()
    (removed,) = remove_leftovers(settings)
    assert removed.path == one.path
    assert list((tmp_path / "out").iterdir()) == []
    assert incomplete_files(settings) == []


def test_an_interrupted_replacement_restores_the_earlier_export(
    settings: Settings, tmp_path: Path
) -> None:
    """An export whose replacement was interrupted between two renames is put back."""
    to = tmp_path / "out" / "export"
    killed(settings, to)
    (one,) = incomplete_files(settings)
    (one.path / "old").mkdir()
    (one.path / "old" / "README.txt").write_text("the one before")
    remove_leftovers(settings)
    assert (to / "README.txt").read_text() == "the one before"
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["export"]


def test_files_on_a_missing_disk_stay_listed(settings: Settings, tmp_path: Path) -> None:
    """Incomplete files on a disk that is not mounted stay listed until they can be removed."""
    killed(settings, tmp_path / "out" / "export")
    (tmp_path / "out").rename(tmp_path / "unplugged")
    assert remove_leftovers(settings, starting=True) == []
    assert len(incomplete_files(settings)) == 1
    (tmp_path / "unplugged").rename(tmp_path / "out")
    assert len(remove_leftovers(settings)) == 1


def test_a_note_with_a_foreign_path_removes_nothing(settings: Settings, tmp_path: Path) -> None:
    """A note whose path is not named like our incomplete files removes nothing."""
    killed(settings, tmp_path / "out" / "export")
    (one,) = incomplete_files(settings)
    assert one.note is not None
    mine = tmp_path / "mine"
    mine.mkdir()
    one.note.write_text(one.note.read_text().replace(str(one.path), str(mine)))
    assert remove_leftovers(settings, starting=True) == []
    assert mine.is_dir()


def test_leftovers_of_a_server_are_removed_at_the_next_start(settings: Settings) -> None:
    """Temporary files that a server left are removed when the next one starts; backups stay."""
    left = [
        uploads_of(settings) / "tmpabc" / "capture",
        settings.data_dir / "scratch" / "exports" / "1.part",
        settings.data_dir / ".beginning-abc" / "reembody.sqlite",
        settings.data_dir / "backups" / ".restoring-abc" / "copy.sqlite",
        settings.data_dir / "backups" / ".before.reembody.1.partial" / "before.reembody",
        settings.data_dir / ".write-test-0",
    ]
    kept = settings.data_dir / "backups" / "before-restore-1.reembody"
    for path in (*left, kept):
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text("somebody's")
    assert remove_leftovers(settings) == []
    assert len(remove_leftovers(settings, starting=True)) == len(left)
    assert [path for path in settings.data_dir.rglob("*") if path.is_file()] == [kept]


def test_a_truncated_note_is_removed_at_a_start(settings: Settings) -> None:
    """A truncated note is removed at the next start."""
    folder = Notes.of(settings).folder
    folder.mkdir()
    (folder / "cut.json").write_text('{"kind": "exp')
    assert incomplete_files(settings) == []
    remove_leftovers(settings, starting=True)
    assert list(folder.iterdir()) == []


def test_a_note_that_cannot_be_removed_is_tolerated(
    settings: Settings, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A note that cannot be removed raises no error and is removed at the next start."""
    to = tmp_path / "out" / "made.reembody"
    notes = Notes.of(settings)

    def refuse(path: Path, **_: object) -> None:
        raise PermissionError(13, "Permission denied", str(path))

    with monkeypatch.context() as patch:
        patch.setattr(Path, "unlink", refuse)
        with partial_folder("backup", to, now=NOW, notes=notes) as folder:
            (folder / "new").write_text("whole")
            (folder / "new").rename(to)
    assert to.read_text() == "whole"
    assert len(list(notes.folder.iterdir())) == 1
    assert remove_leftovers(settings, starting=True) == []
    assert list(notes.folder.iterdir()) == []


def test_notes_and_incomplete_files_are_private(settings: Settings, tmp_path: Path) -> None:
    """Notes and the folders of incomplete files are private to their owner."""
    to = tmp_path / "out" / "export"
    with partial_folder("export", to, now=NOW, notes=Notes.of(settings)) as folder:
        assert folder.stat().st_mode & 0o077 == 0
        assert Notes.of(settings).folder.stat().st_mode & 0o077 == 0
