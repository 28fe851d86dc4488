"""Tests that a failed disk call is reported with a message, and that no data are lost or moved.

The benchmark `io_faults` does this at every call of eight operations; these tests try a few calls
of each kind.
"""

import json
import pickle
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.benchmarks.io_faults import PROGRAM, REPOSITORY
from tests.faults.figures import note
from tests.faults.io_faults import source_in
from tests.faults.tracing.injecting import injecting_machine
from tests.faults.tracing.running import why_not
from tests.support.nursery import nursery

FEW, MANY = 5, 40


@pytest.fixture(scope="module")
def source(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Provide the data folder from which every run starts."""
    folder = tmp_path_factory.mktemp("source")
    refused = why_not(folder)
    if refused or injecting_machine() is None:
        pytest.skip(refused or "system calls of this machine cannot be made to fail")
    (folder / "source").write_bytes(pickle.dumps(source_in(folder / "live")))
    return folder / "source"


def tried(source: Path, operation: str, most: int) -> list[dict[str, Any]]:
    """Inject about `most` faults into an operation and return the problems found."""
    result = source.with_name("result.json")
    workers = nursery().workers.hex()
    arguments = [str(source), operation, workers, str(most), str(result)]
    subprocess.run([sys.executable, "-c", PROGRAM, *arguments], cwd=REPOSITORY, check=True)
    found: list[dict[str, Any]] = json.loads(result.read_text(encoding="utf-8"))["found"]
    return found


@pytest.mark.timeout(3600)
@pytest.mark.parametrize(
    ("operation", "most"),
    [
        ("start", FEW),
        ("restore --replace", FEW),
        *(
            pytest.param(operation, MANY, marks=pytest.mark.long)
            for operation in ("first start", "restore", "backup", "export", "upload", "erasure")
        ),
    ],
)
def test_a_failed_disk_call_is_reported_without_loss(
    source: Path, operation: str, most: int
) -> None:
    """A failed disk call is reported without loss of acknowledged data or a traceback.

    No healthy database is moved, and no unknown file is left.
    """
    found = tried(source, operation, most)
    hit = [one for one in found if one["hit"]]
    note(6, f"{operation}: a call to the disk fails", "injected", len(hit))
    assert len(hit) >= min(FEW, most) - 2
    for one in hit:
        assert (one["lost"], one["unknown"], one["moved"]) == ([], [], []), one
        assert not one["outcome"]["trace"], one
