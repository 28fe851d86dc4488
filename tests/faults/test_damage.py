"""Tests that a start with randomly damaged files ends in serving or in quarantine.

Fault 6 of the matrix, with random damage: bits flipped, files cut, parts zeroed, in the database,
its log and the log's index. Each kind of damage alone is tested in tests/features/care/opening.
"""

import os
from collections import Counter
from pathlib import Path

import pytest

from tests.faults.damage import Folder, left_by_a_killed_server, many
from tests.faults.figures import note

SHORT, LONG = 12, 1000
SEED = 6


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Folder:
    """Provide the data folder of a server that was killed in the middle of a visit."""
    return left_by_a_killed_server(tmp_path_factory.mktemp("killed"))


def try_many(folder: Folder, elsewhere: Path, count: int, processes: int = 1) -> None:
    """Damage `count` copies and assert that each start serves or quarantines the database."""
    cases = many(folder, elsewhere, count, SEED, processes=processes)
    ends = Counter(case.end for case in cases)
    note(6, f"{count} random damages", "served", ends["served"])
    note(6, f"{count} random damages", "quarantined, restored", ends["quarantined"])
    note(6, f"{count} random damages", "tracebacks", ends["traceback"])
    assert [case for case in cases if case.end not in ("served", "quarantined")] == []
    assert [case for case in cases if case.end == "quarantined" and not case.has_advice] == []
    assert [case for case in cases if case.errors] == []


def test_damage_ends_in_serving_or_in_quarantine(folder: Folder, tmp_path: Path) -> None:
    """A start with damaged files never ends in a traceback, and a restored backup can be served."""
    try_many(folder, tmp_path, SHORT)


@pytest.mark.long
@pytest.mark.timeout(14_400)
def test_much_damage_ends_in_serving_or_in_quarantine(folder: Folder, tmp_path: Path) -> None:
    """No start of a thousand with damaged files ends in a traceback; restored backups serve."""
    try_many(folder, tmp_path, LONG, os.cpu_count() or 1)
