"""Tests that damage to a database file is detected without changing the file."""

import sqlite3
import subprocess
import sys
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from app.features.care.opening import inspection
from app.features.care.opening.inspection import damage_of, foreign_tables, is_open_elsewhere
from tests.faults.figures import note
from tests.features.care.opening.files import filled, flip, killed, log

PAGE = 4096
STEPS = [5, pytest.param(1, marks=pytest.mark.long)]
"""Every fifth page, which meets the header and pages of each kind; in the long form every page."""


@pytest.fixture
def file(tmp_path: Path) -> Path:
    """Return the path of an intact Reembody database."""
    return filled(tmp_path / "reembody.sqlite")


def overwritten(file: Path, step: int, *, noise: bool) -> Iterator[tuple[int, str | None]]:
    """Overwrite one page at a time; yield its number and the damage that is reported."""
    rng = np.random.default_rng(6)
    data = file.read_bytes()
    with file.open("r+b", buffering=0) as written:
        for start in range(0, len(data), step * PAGE):
            written.seek(start)
            written.write(rng.bytes(PAGE) if noise else bytes(PAGE))
            yield start // PAGE, damage_of(file)
            written.seek(start)
            written.write(data[start : start + PAGE])


def ends_of_blobs(file: Path) -> set[int]:
    """Return the pages that contain the end of a long value: their next-page number is zero."""
    data = file.read_bytes()
    pages = range(len(data) // PAGE)
    return {page for page in pages if data[page * PAGE : page * PAGE + 4] == bytes(4)}


def test_an_intact_database_passes(file: Path, tmp_path: Path) -> None:
    """An intact database passes inspection, even if it was left by a killed process."""
    assert damage_of(file) is None
    assert damage_of(killed(tmp_path / "killed.sqlite")) is None


def test_inspecting_a_database_changes_nothing(tmp_path: Path) -> None:
    """Inspecting an intact or damaged database changes neither its file nor its log."""
    file = killed(filled(tmp_path / "reembody.sqlite"))
    for place in (None, 200, 3 * PAGE + 1):
        if place is not None:
            flip(file, place)
        before = file.read_bytes(), log(file).read_bytes()
        damage_of(file)
        foreign_tables(file) if place is None else None
        assert (file.read_bytes(), log(file).read_bytes()) == before


@pytest.mark.parametrize("step", STEPS)
def test_a_page_of_noise_is_detected(file: Path, step: int) -> None:
    """A page overwritten with noise is detected wherever it is in the file."""
    found = dict(overwritten(file, step, noise=True))
    note(6, "a page of noise", "noticed", count(found))
    assert [page for page, damage in found.items() if damage is None] == []


@pytest.mark.parametrize("step", STEPS)
def test_a_page_of_zeros_is_detected(file: Path, step: int) -> None:
    """A page overwritten with zeros is detected, except one with only the end of a long value."""
    ends = ends_of_blobs(file)
    found = dict(overwritten(file, step, noise=False))
    unnoticed = {page for page, damage in found.items() if damage is None}
    note(6, "a page of zeros", "noticed", count(found))
    note(6, "a page of zeros", "of the others: ends of long values", len(unnoticed & ends))
    assert unnoticed <= ends


def test_a_changed_value_is_not_detected_by_inspection(file: Path) -> None:
    """A changed byte inside a value is not detected: only the structure of the file is checked.

    Other checks protect values: event logs have a hash chain; movement chunks and the tables of a
    backup have checksums.
    """
    data = file.read_bytes()
    place = data.index(bytes(range(256)) * 3)
    flip(file, place + 300)
    assert damage_of(file) is None


@pytest.mark.parametrize("length", [0, 1, 15, 16, 99, 100, PAGE - 1, PAGE, 9 * PAGE, -PAGE, -1])
def test_a_truncated_file_is_detected(file: Path, length: int) -> None:
    """A truncated database file is detected at any length, even if it is empty."""
    file.write_bytes(file.read_bytes()[:length])
    assert damage_of(file) is not None


@pytest.mark.parametrize("start", [b"\0" * 16, b"PK\x03\x04" + b"x" * 12, b"SQLite format 4\0"])
def test_a_wrong_file_signature_is_detected(file: Path, start: bytes) -> None:
    """A file that does not begin with SQLite's signature is reported as not being a database."""
    file.write_bytes(start + file.read_bytes()[16:])
    assert damage_of(file) == "it is not a SQLite database"


def test_a_damaged_log_is_detected(file: Path) -> None:
    """A damaged write-ahead log is detected, even if SQLite would accept the rest of it."""
    killed(file)
    assert damage_of(file) is None
    flip(log(file), 5 * PAGE)
    assert "transactions cannot be read" in (damage_of(file) or "")
    flip(log(file), 5 * PAGE)
    flip(log(file), 17)
    assert damage_of(file) == "the beginning of its log is damaged"


def test_a_log_torn_by_a_power_failure_passes(file: Path) -> None:
    """A log with a torn end, as a power failure leaves it, is not damage."""
    killed(file)
    log(file).write_bytes(log(file).read_bytes()[:-5000])
    Path(f"{file}-shm").unlink()  # an index never lists frames that were not flushed
    assert damage_of(file) is None


@pytest.mark.parametrize("length", [0, 20, 32, 9 * PAGE, -5000, -1])
def test_a_log_without_its_committed_end_is_detected(file: Path, length: int) -> None:
    """A log shorter than its index states is detected; SQLite would silently ignore the loss."""
    killed(file)
    log(file).write_bytes(log(file).read_bytes()[:length])
    assert "cannot be read" in (damage_of(file) or "")


def test_a_torn_or_foreign_index_is_ignored(file: Path, tmp_path: Path) -> None:
    """A log index that is torn or belongs to another log is ignored."""
    killed(file)
    index = Path(f"{file}-shm")
    whole = index.read_bytes()
    log(file).write_bytes(log(file).read_bytes()[:-5000])
    for torn in (whole[:90], bytes(100) + whole[100:], whole[:16] + b"\xff" + whole[17:]):
        index.write_bytes(torn)
        assert damage_of(file) is None
    other = killed(filled(tmp_path / "other.sqlite"))
    index.write_bytes(Path(f"{other}-shm").read_bytes())
    assert damage_of(file) is None


def test_a_large_file_is_checked_only_after_an_unclean_end(
    file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A large database is checked in full only if it was not closed normally."""
    monkeypatch.setattr(inspection, "ALWAYS_CHECKED_BYTES", 10 * PAGE)
    data = file.read_bytes()
    page = 30 * PAGE
    file.write_bytes(data[:page] + b"\xff" * PAGE + data[page + PAGE :])
    assert damage_of(file) is None
    killed(file)
    assert damage_of(file) is not None


def test_another_programs_database_is_known_by_its_tables(file: Path, tmp_path: Path) -> None:
    """Another program's database is recognised by its tables; our own is not called foreign."""
    other, new = tmp_path / "other.sqlite", tmp_path / "new.sqlite"
    with closing(sqlite3.connect(other)) as connection:
        connection.execute("CREATE TABLE bookmarks (x)")
    with closing(sqlite3.connect(new)) as connection:
        connection.execute("PRAGMA journal_mode=WAL")
    assert foreign_tables(other) == ["bookmarks"]
    assert foreign_tables(file) == []
    assert foreign_tables(new) == []


def test_a_disk_read_error_is_not_damage(file: Path) -> None:
    """A page that the disk fails to read raises an OSError and does not count as damage."""
    words = "*** in database main ***\nPage 90: unable to get the page. error code="
    with pytest.raises(OSError, match="Input/output error"):
        inspection._require_read(file, f"{words}8458")
    inspection._require_read(file, f"{words}11")
    inspection._require_read(file, "row 7 missing from index ix_events")


def test_a_database_open_in_another_process_is_detected(file: Path) -> None:
    """A database that another process has open is detected, even while that process is idle."""
    assert not is_open_elsewhere(file)
    program = (
        "import sqlite3, sys\n"
        "connection = sqlite3.connect(sys.argv[1])\n"
        "connection.execute('SELECT count(*) FROM accounts').fetchone()\n"
        "print('open', flush=True)\n"
        "sys.stdin.read()\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", program, str(file)], stdin=subprocess.PIPE, stdout=subprocess.PIPE
    ) as other:
        assert other.stdout is not None
        assert other.stdout.readline() == b"open\n"
        assert is_open_elsewhere(file)
        other.communicate()
    assert not is_open_elsewhere(file)


def count(found: dict[int, str | None]) -> str:
    """Return the share of cases in which damage was detected, as "n of m"."""
    noticed = sum(damage is not None for damage in found.values())
    return f"{noticed} of {len(found)}"
