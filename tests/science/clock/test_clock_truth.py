"""Tests of the clock mapping on simulated clocks. `./run bench clock` prints the figures."""

import numpy as np
import pytest

from tests.science.clock.simulated import ASYMMETRIC, SYMMETRIC, Scenario, outcome


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("scenario", SYMMETRIC, ids=lambda scenario: scenario.name)
def test_on_symmetric_paths_the_error_is_small(scenario: Scenario, seed: int) -> None:
    """On symmetric paths 95 % of errors are within 5 ms despite drift, steps, queues and losses."""
    found = outcome(scenario, np.random.default_rng(seed))
    assert found.residual_p95_ms <= 5.0
    assert found.coverage >= 0.999
    assert found.negative == 0
    assert found.bound_p95_ms < 20.0


@pytest.mark.parametrize("seed", [1, 2, 3])
@pytest.mark.parametrize("scenario", ASYMMETRIC, ids=lambda scenario: scenario.name)
def test_on_asymmetric_paths_the_bound_holds(scenario: Scenario, seed: int) -> None:
    """On asymmetric paths the bound covers the error, which neither end can see."""
    found = outcome(scenario, np.random.default_rng(seed))
    assert found.coverage >= 0.999
    assert found.negative == 0
    assert 15.0 < found.residual_p95_ms <= found.bound_p95_ms
    assert found.bound_p50_ms < 30.0


def test_impossible_probes_are_left_out_one_by_one() -> None:
    """All twenty impossible probes are left out, and no others."""
    (scenario,) = [one for one in SYMMETRIC if one.wrong]
    found = outcome(scenario, np.random.default_rng(4))
    assert found.left_out == scenario.wrong
