"""Test that the stored movement of a body that is tried is still the server's."""

import json

import pytest

from tests.science.avatar.simulation.tried_vectors import CASES, FILE, tried


@pytest.mark.parametrize("row", range(len(CASES)))
def test_the_stored_body_is_still_the_servers(row: int) -> None:
    """Driving, pushing, dropping a box and a latency move the body as the vectors say."""
    expected, made = json.loads(FILE.read_text())["cases"][row]["samples"], tried(CASES[row])
    for found, sample in zip(made, expected, strict=True):
        assert found["qpos"] == pytest.approx(sample["qpos"], abs=1e-9)
        assert found["torque_nm"] == pytest.approx(sample["torque_nm"], abs=1e-6)
