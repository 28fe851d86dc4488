"""Tests of walking models that are fitted to a few real people and tried on others."""

from pathlib import Path

import pytest

from tests.benchmarks.walking_real import real_walks


@pytest.mark.long
def test_others_are_as_fast_as_predicted(shared_data: Path) -> None:
    """Peak speeds of eight others at ten distances are predicted to one between-subject SD."""
    found = real_walks(shared_data)
    assert len(found.distances) == 10
    assert not set(found.fit.database.subjects) & {one.walk.subject for one in found.captured}
    for one in found.distances:
        assert one.off_sds <= 1.0, f"{one.distance_m} m"
    scores = {name: outcome.mean_crps_s for name, outcome in found.captures.outcomes.items()}
    assert scores["prob"] < scores["adapt"]
