"""Damaged C3D, TRC and ASF/AMC files: a capture or a reason, never a crash, a hang or a warning."""

import pytest

from tests.adapters.captures.fuzzing import assert_family_survives
from tests.adapters.captures.marker_seeds import marker_seeds

_SHORT = 225
_SEEDS = marker_seeds()


@pytest.mark.parametrize("key", _SEEDS)
def test_damaged_files_are_read_or_refused(key: str) -> None:
    """Cut, flipped, doubled, with huge and empty numbers, and so are the files beside them."""
    name, seeds = _SEEDS[key]
    assert_family_survives(seeds, name, _SHORT)


@pytest.mark.long
@pytest.mark.parametrize("key", _SEEDS)
def test_damaged_files_are_read_or_refused_at_length(key: str) -> None:
    """The same, eighty times as often."""
    name, seeds = _SEEDS[key]
    assert_family_survives(seeds, name, 80 * _SHORT)
