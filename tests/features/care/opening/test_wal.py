"""Tests that the write-ahead log is read as SQLite reads it, and lost transactions are detected.

The reference is SQLite itself, which reports how many frames of a log it uses.
"""

import shutil
import sqlite3
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest

from app.features.care.opening.wal import FRAME_HEADER, HEADER, LogReport, inspect_log
from tests.features.care.opening.files import flip, killed, log

ROWS = 40


def taken_by_sqlite(file: Path, folder: Path) -> int:
    """Return how many frames of the log SQLite uses, measured on a copy."""
    folder.mkdir()
    copy = folder / file.name
    shutil.copyfile(file, copy)
    shutil.copyfile(log(file), log(copy))
    with closing(sqlite3.connect(copy)) as connection:
        _, frames, _ = connection.execute("PRAGMA wal_checkpoint(PASSIVE)").fetchone()
    return int(frames)


@pytest.mark.parametrize("page_size", [512, 4096, 65536])
def test_a_log_left_by_a_crash_is_valid(tmp_path: Path, page_size: int) -> None:
    """Every frame of a log left by a killed process is usable, at any page size."""
    file = killed(tmp_path / "some.sqlite", page_size=page_size)
    report = inspect_log(log(file))
    assert report == LogReport(
        header_valid=True, usable=taken_by_sqlite(file, tmp_path / "copy"), commits_after_invalid=0
    )
    assert report.usable == (log(file).stat().st_size - HEADER) // (FRAME_HEADER + page_size)
    assert not report.damaged


def test_a_torn_end_is_not_damage(tmp_path: Path) -> None:
    """A log truncated anywhere is not damaged, and has as many usable frames as SQLite finds."""
    file = killed(tmp_path / "some.sqlite")
    whole = log(file).read_bytes()
    rng = np.random.default_rng(3)
    for at, length in enumerate(rng.integers(0, len(whole), size=12)):
        log(file).write_bytes(whole[:length])
        report = inspect_log(log(file))
        assert not report.damaged, length
        assert report.usable == max(0, taken_by_sqlite(file, tmp_path / str(at))), length


def test_damage_is_distinguished_from_a_torn_end(tmp_path: Path) -> None:
    """A flipped bit before the last two transactions is damage; SQLite would drop them silently."""
    file = killed(tmp_path / "some.sqlite", rows=ROWS)
    whole = log(file).read_bytes()
    rng = np.random.default_rng(4)
    # The two longest rows take fewer than 8 frames.
    end = len(whole) - 8 * (FRAME_HEADER + 4096)
    for at, place in enumerate(rng.integers(HEADER, end, size=12)):
        log(file).write_bytes(whole)
        flip(log(file), int(place))
        report = inspect_log(log(file))
        assert report.damaged, place
        assert report.usable == taken_by_sqlite(file, tmp_path / str(at)), place


def test_unwritten_sectors_are_not_damage(tmp_path: Path) -> None:
    """Frames after a torn end that have the log's salts but random content are not damage."""
    file = killed(tmp_path / "some.sqlite", rows=ROWS)
    whole = log(file).read_bytes()
    frame = FRAME_HEADER + 4096
    count = (len(whole) - HEADER) // frame
    noise = np.random.default_rng(5).bytes(len(whole))
    torn = bytearray(whole)
    for number in range(count // 2, count):
        start = HEADER + number * frame
        torn[start : start + frame] = noise[start : start + frame]
        torn[start + 8 : start + 16] = whole[16:24]
    log(file).write_bytes(torn)
    report = inspect_log(log(file))
    assert not report.damaged
    assert report.usable == taken_by_sqlite(file, tmp_path / "copy")


def test_a_damaged_log_header_is_damage(tmp_path: Path) -> None:
    """A damaged log header counts as damage; SQLite would treat the whole log as empty."""
    file = killed(tmp_path / "some.sqlite")
    for place in (0, 9, 20, 31):
        whole = log(file).read_bytes()
        flip(log(file), place)
        assert inspect_log(log(file)).damaged
        log(file).write_bytes(whole)


def test_frames_of_an_earlier_log_are_not_damage(tmp_path: Path) -> None:
    """Frames that an earlier log left at the end of a restarted one are not damage."""
    file = killed(tmp_path / "some.sqlite", rows=30)
    with closing(sqlite3.connect(file)) as connection:
        connection.execute("PRAGMA wal_checkpoint(RESTART)")
        # Another reader keeps the log from being removed when this one closes.
        with closing(sqlite3.connect(f"file:{file}?mode=ro", uri=True)) as reader:
            reader.execute("SELECT count(*) FROM written").fetchone()
            connection.execute("INSERT INTO written VALUES (1, 'x')")
            connection.commit()
            connection.close()
            report = inspect_log_of_copy(file, tmp_path / "copy")
    assert 0 < report.usable < 5
    assert report.commits_after_invalid == 0


def inspect_log_of_copy(file: Path, folder: Path) -> LogReport:
    """Inspect a copy of a log that this process has open."""
    folder.mkdir()
    shutil.copyfile(log(file), folder / "some-wal")
    return inspect_log(folder / "some-wal")


def test_a_missing_or_empty_log_is_not_damage(tmp_path: Path) -> None:
    """A missing or empty write-ahead log is not damage."""
    (tmp_path / "empty-wal").touch()
    assert not inspect_log(tmp_path / "empty-wal").damaged
    assert not inspect_log(tmp_path / "missing-wal").damaged
