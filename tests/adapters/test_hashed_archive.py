"""Tests of archives that notice damage: every wrong bit and every other file is refused."""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path

import numpy as np
import pytest

from app.adapters.hashed_archive import ArchiveKind

KIND = ArchiveKind("thing", 1, ("numbers",), "a thing", "make", ValueError)


@pytest.fixture
def archive(tmp_path: Path) -> Path:
    """Return a file with one table."""
    path = tmp_path / "thing.npz"
    KIND.write(path, {"about": "nothing"}, {"numbers": np.arange(40.0)})
    return path


def _saved(save: Callable[[BytesIO], None]) -> bytes:
    file = BytesIO()
    save(file)
    return file.getvalue()


def test_a_single_wrong_bit_never_passes_unnoticed(archive: Path) -> None:
    """With any bit of any third byte changed a file is refused in words, or its content is whole.

    The archive has bits that carry nothing, such as the time at which it was written.
    """
    whole, (_, tables, digest) = archive.read_bytes(), KIND.read(archive)
    refused = 0
    for at in range(0, len(whole), 3):
        changed = bytearray(whole)
        changed[at] ^= 1 << at % 8
        archive.write_bytes(changed)
        try:
            _, found, again = KIND.read(archive)
        except ValueError as error:
            refused += 1
            assert "not a thing" in str(error) or "damaged" in str(error), error  # noqa: PT017
        else:
            assert again == digest
            assert (found["numbers"] == tables["numbers"]).all()
    assert refused > len(whole) / 6


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"subject,time_s\n",
        _saved(lambda file: np.save(file, np.zeros(3))),
        _saved(lambda file: np.savez(file, header=np.zeros(3))),
        _saved(lambda file: np.savez(file, other=np.zeros(3))),
    ],
)
def test_any_other_file_is_refused_by_what_it_is_not(content: bytes, tmp_path: Path) -> None:
    """Texts, single arrays and other archives are named, with the command that writes a thing."""
    path = tmp_path / "other.npz"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"other\.npz: not a thing; `make` writes one"):
        KIND.read(path)
    assert not KIND.is_one(path)


def test_a_file_of_another_version_is_of_the_kind(archive: Path) -> None:
    """The kind of a file is known whatever its version, and that of another kind is not it."""
    assert KIND.is_one(archive)
    assert ArchiveKind("thing", 2, (), "a thing", "make", ValueError).is_one(archive)
    assert not ArchiveKind("song", 1, (), "a song", "sing", ValueError).is_one(archive)
