"""Tests of simulated questionnaire answers."""

import numpy as np
import pytest

from app.science.simulation import (
    Aspect,
    SimulatedItem,
    SimulationError,
    agreement,
    simulated_answers,
)

_ITEM = SimulatedItem("q", 1, 7, Aspect.AGENCY)


def _mean(item: SimulatedItem, direction: int, latency_ms: float, limb: str = "hand") -> float:
    rng = np.random.default_rng(2)
    drawn = [simulated_answers([item], {"q": direction}, latency_ms, limb, rng) for _ in range(400)]
    return float(np.mean([answers["q"] for answers in drawn]))


def test_agreement_falls_with_latency() -> None:
    """Agreement falls with latency, and reversed items mirror it."""
    agrees = [_mean(_ITEM, 1, latency) for latency in (0.0, 125.0, 350.0)]
    assert agrees == sorted(agrees, reverse=True)
    assert agrees[0] - agrees[2] > 0.8
    for latency, value in zip((0.0, 125.0, 350.0), agrees, strict=True):
        assert _mean(_ITEM, -1, latency) == pytest.approx(8.0 - value, abs=0.15)


def test_unrelated_items_stay_in_the_middle() -> None:
    """Answers to an item of direction 0 do not depend on latency."""
    assert _mean(_ITEM, 0, 0.0) == pytest.approx(4.0, abs=0.15)
    assert _mean(_ITEM, 0, 350.0) == pytest.approx(4.0, abs=0.15)


def test_published_agreement_is_met() -> None:
    """At the measured latencies the answers match the table of Waltemate et al. (2016)."""
    assert agreement(Aspect.AGENCY, 0.0) == pytest.approx(0.96)
    assert agreement(Aspect.OWNERSHIP, 165.0) == pytest.approx(0.90)
    assert agreement(Aspect.SIMULTANEITY, 305.0) == pytest.approx(0.1225)
    assert agreement(Aspect.AGENCY, 2000.0) == pytest.approx(0.715)


def test_answers_are_on_the_scale_and_reproducible() -> None:
    """Every answer is a whole number on its scale, determined by the seed."""
    items = [SimulatedItem(f"q{i}", -3, 3) for i in range(30)]
    first = simulated_answers(items, {}, 350.0, "foot", np.random.default_rng(3))
    repeated = simulated_answers(items, {}, 350.0, "foot", np.random.default_rng(3))
    assert first == repeated
    assert list(first) == [item.key for item in items]
    assert all(isinstance(answer, int) and -3 <= answer <= 3 for answer in first.values())


@pytest.mark.parametrize(
    ("direction", "latency_ms", "limb", "maximum"),
    [(2, 0.0, "hand", 7), (1, -1.0, "hand", 7), (1, 0.0, "knee", 7), (1, 0.0, "hand", 1)],
)
def test_impossible_requests_are_rejected(
    direction: int, latency_ms: float, limb: str, maximum: int
) -> None:
    """Unknown directions and limbs, negative latencies and empty scales are rejected."""
    with pytest.raises(SimulationError):
        simulated_answers(
            [SimulatedItem("q", 1, maximum)], {"q": direction}, latency_ms, limb,
            np.random.default_rng(1),
        )  # fmt: skip
