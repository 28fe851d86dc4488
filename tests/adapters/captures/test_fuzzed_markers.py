"""Tests that damaged C3D, TRC and ASF/AMC files are read or rejected without a crash or hang."""

import pytest

from tests.adapters.captures.fuzzing import assert_family_survives
from tests.adapters.captures.marker_seeds import marker_seeds

pytestmark = pytest.mark.thorough

_SHORT = 225
_SEEDS = marker_seeds()


@pytest.mark.parametrize("key", _SEEDS)
def test_damaged_files_are_read_or_rejected(key: str) -> None:
    """Damaged marker files and companion files are read or rejected with a `CaptureError`."""
    name, seeds = _SEEDS[key]
    assert_family_survives(seeds, name, _SHORT)


@pytest.mark.long
@pytest.mark.parametrize("key", _SEEDS)
def test_many_damaged_files_are_read_or_rejected(key: str) -> None:
    """Eighty times as many damaged marker files as in the short test are read or rejected."""
    name, seeds = _SEEDS[key]
    assert_family_survives(seeds, name, 80 * _SHORT)
