"""Test that the stored movement of the remote body is still that of the scripted headset."""

import json

import pytest

from tests.science.avatar.simulation.followed_vectors import CASES, FILE, followed


@pytest.mark.parametrize("row", range(len(CASES)))
def test_the_stored_body_is_that_of_the_scripted_headset(row: int) -> None:
    """The scripted headset's body moves and touches as the vectors for other clients say."""
    stored = json.loads(FILE.read_text())
    expected, made = stored["cases"][row], followed(CASES[row], stored["keys"])
    assert made["held_rad"] == [pytest.approx(one, abs=1e-9) for one in expected["held_rad"]]
    for found, sample in zip(made["samples"], expected["samples"], strict=True):
        assert (found["touched"], found["near"]) == (sample["touched"], sample["near"])
        assert found["pose"] == pytest.approx(sample["pose"], abs=1e-9)
