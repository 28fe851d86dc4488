"""A damaged database is put away whole, and an interruption loses no part of it."""

from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.features.care.opening.quarantine import SUFFIXES, Quarantine

NOW = datetime(2026, 11, 21, 6, 11, 8, 123456, UTC)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """A database with all that may belong to it, each with its own content."""
    file = tmp_path / "reembody.sqlite"
    for suffix in SUFFIXES:
        Path(f"{file}{suffix}").write_text(f"content of {suffix}")
    return file


def held(folder: Path) -> dict[str, str]:
    """What lies in a folder, but for the note."""
    return {path.name: path.read_text() for path in folder.iterdir() if path.suffix != ".txt"}


def test_everything_goes_and_nothing_is_changed(file: Path, tmp_path: Path) -> None:
    """Into a folder named by the moment, with a note that says why."""
    before = held(tmp_path)
    place = Quarantine(file).put_away("it is damaged", NOW)
    assert place == tmp_path / "quarantine" / "20261121T061108.123456Z"
    assert held(place) == before
    assert "Why: it is damaged." in (place / "unresolved.txt").read_text()
    assert [path.name for path in tmp_path.iterdir()] == ["quarantine"]


@pytest.mark.parametrize("moved", range(len(SUFFIXES)))
def test_an_interrupted_move_is_finished(
    file: Path, tmp_path: Path, moved: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """However far it came: the database and its log are never apart for good."""
    before, honest, done = held(tmp_path), Path.rename, 0

    def interrupted(self: Path, target: Path) -> Path:
        nonlocal done
        if done == moved:
            raise KeyboardInterrupt
        done += 1
        return honest(self, target)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "rename", interrupted)
        with pytest.raises(KeyboardInterrupt):
            Quarantine(file).put_away("it is damaged", NOW)
    assert Quarantine(file).unresolved() == []
    Quarantine(file).finish()
    (place,) = Quarantine(file).unresolved()
    assert held(place) == before


def test_it_stays_unresolved_until_somebody_decides(file: Path) -> None:
    """Also over several; what is resolved stays where it is."""
    quarantine = Quarantine(file)
    assert quarantine.unresolved() == []
    first = quarantine.put_away("once", NOW)
    file.write_text("another")
    second = quarantine.put_away("twice", NOW.replace(hour=7))
    assert quarantine.unresolved() == [first, second]
    quarantine.resolve()
    assert quarantine.unresolved() == []
    assert (second / "reembody.sqlite").read_text() == "another"
    assert (second / "resolved.txt").is_file()
