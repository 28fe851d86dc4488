"""Tests of what is said of an export that could not be written."""

import errno
from datetime import UTC, datetime
from pathlib import Path

import pytest

from app.features.results.exports.worker_messages import ExportFailure, ExportOrder
from app.features.results.exports.writing import export_task


@pytest.mark.parametrize(
    ("error", "message", "remedy"),
    [
        (
            OSError(errno.ENOSPC, "No space left on device"),
            "the disk of the server is full",
            "Free space",
        ),
        (OSError(errno.EACCES, "Permission denied"), "the operating system denied access", "Check"),
        (OSError(errno.ENOTDIR, "Not a directory"), "NotADirectoryError", "Make it again"),
    ],
)
def test_an_export_that_cannot_be_written_says_why(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, error: OSError, message: str, remedy: str
) -> None:
    """An export stopped by a full disk says so, as everything else does, and what to do first."""

    def refuse(_: ExportOrder) -> None:
        raise error

    monkeypatch.setattr(export_task, "_write_export", refuse)
    order = ExportOrder(
        "sqlite://",
        "latency",
        "people",
        None,
        movement=False,
        now=datetime(2030, 1, 1, tzinfo=UTC),
        to=tmp_path / "export.zip",
        meter=tmp_path / "meter",
        keep_free_bytes=0,
    )
    failed = export_task.make_export(order)
    assert isinstance(failed, ExportFailure)
    assert failed.message.startswith(f"the export could not be written: {message}")
    assert failed.remedy.startswith(remedy)
