"""Tests that quarantine moves a damaged database with all its files, even if interrupted."""

from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.features.care.opening.quarantine import SUFFIXES, Quarantine

NOW = datetime(2026, 11, 21, 6, 11, 8, 123456, UTC)


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Return the path of a database with all its side files, each with different content."""
    file = tmp_path / "reembody.sqlite"
    for suffix in SUFFIXES:
        Path(f"{file}{suffix}").write_text(f"content of {suffix}")
    return file


def contents_of(folder: Path) -> dict[str, str]:
    """Return the text of every file in a folder, without the quarantine's note."""
    return {path.name: path.read_text() for path in folder.iterdir() if path.suffix != ".txt"}


def test_quarantine_moves_every_file_unchanged(file: Path, tmp_path: Path) -> None:
    """Quarantine moves all files unchanged to a timestamped folder, with a note of the reason."""
    before = contents_of(tmp_path)
    place = Quarantine(file).put_away("it is damaged", NOW)
    assert place == tmp_path / "quarantine" / "20261121T061108.123456Z"
    assert contents_of(place) == before
    assert "Why: it is damaged." in (place / "unresolved.txt").read_text()
    assert [path.name for path in tmp_path.iterdir()] == ["quarantine"]


@pytest.mark.parametrize("moved", range(len(SUFFIXES)))
def test_an_interrupted_move_is_finished(
    file: Path, tmp_path: Path, moved: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A move to quarantine that was interrupted after any file is finished by the next start."""
    before, original, done = contents_of(tmp_path), Path.rename, 0

    def interrupted(self: Path, target: Path) -> Path:
        nonlocal done
        if done == moved:
            raise KeyboardInterrupt
        done += 1
        return original(self, target)

    with monkeypatch.context() as patch:
        patch.setattr(Path, "rename", interrupted)
        with pytest.raises(KeyboardInterrupt):
            Quarantine(file).put_away("it is damaged", NOW)
    assert Quarantine(file).unresolved() == []
    Quarantine(file).finish()
    (place,) = Quarantine(file).unresolved()
    assert contents_of(place) == before


def test_a_quarantine_stays_unresolved_until_resolved(file: Path) -> None:
    """Quarantines stay unresolved until `resolve`, which leaves their files in place."""
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
