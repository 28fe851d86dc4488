"""Tests of files that are written completely or not at all."""

import errno
import os
from pathlib import Path

import pytest

from app.whole_files import NotWritten, prepared, write_whole
from tests.support.small_files import small_files


def test_a_full_disk_leaves_the_file_that_is_there(tmp_path: Path) -> None:
    """Content that does not fit changes nothing, leaves nothing behind, and says what to do."""
    file = tmp_path / "kept.json"
    write_whole(file, "before")
    with small_files(), pytest.raises(NotWritten) as raised:
        write_whole(file, b"x" * 5000)
    assert raised.value.errno == errno.EFBIG
    assert str(raised.value).startswith(f"{file} was not written: its disk is full")
    assert str(raised.value).endswith("The file that is there is unchanged.")
    assert file.read_text() == "before"
    assert list(tmp_path.iterdir()) == [file]


def test_what_fails_meanwhile_leaves_the_file_as_it_was(tmp_path: Path) -> None:
    """The new content takes the file's place only once the block that needs it has succeeded."""
    file = tmp_path / "kept.json"
    file.write_text("before")
    file.chmod(0o640)

    def interrupted() -> None:
        with prepared(file, "after"):
            assert file.read_text() == "before"
            raise ValueError("refused")

    with pytest.raises(ValueError, match="refused"):
        interrupted()
    assert (file.read_text(), list(tmp_path.iterdir())) == ("before", [file])
    with prepared(file, lambda out: out.write(b"after")):
        assert file.read_text() == "before"
    assert (file.read_text(), file.stat().st_mode & 0o777) == ("after", 0o640)


def test_links_and_devices_stay_what_they_are(tmp_path: Path) -> None:
    """A link still leads to the file that was written; a device is written to and not replaced."""
    link = tmp_path / "link"
    link.symlink_to(tmp_path / "file")
    write_whole(link, "text")
    assert link.is_symlink()
    assert (tmp_path / "file").read_text() == "text"
    write_whole(Path(os.devnull), "text")
    reading, writing = os.pipe()
    write_whole(Path(f"/dev/fd/{writing}"), "text")
    assert os.read(reading, 10) == b"text"
    os.close(reading)
    os.close(writing)
    assert Path(os.devnull).is_char_device()
    with pytest.raises(NotWritten, match="/dev/full was not written: its disk is full"):
        write_whole(Path("/dev/full"), "text")


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("none/out", "there is no folder"),
        ("file/out", "part of that path is a file"),
        ("folder", "it is a folder"),
        ("n" * 256, "was not written: File name too long"),
    ],
)
def test_a_place_that_cannot_be_written_is_named(tmp_path: Path, name: str, said: str) -> None:
    """Each reason why there can be no such file is told in words, with the file's name."""
    (tmp_path / "file").touch()
    (tmp_path / "folder").mkdir()
    with pytest.raises(NotWritten) as raised:
        write_whole(tmp_path / name, "text")
    assert said in str(raised.value)
    assert "Errno" not in str(raised.value)
