"""Simulated answers to a questionnaire: placeholders for trying the product out, never data.

Agreement falls with latency along published means (Waltemate et al. 2016, "The impact of latency on
perceptual judgments and motor performance in closed-loop interaction in virtual reality", N = 10),
by the end-to-end delay of a base of 45 ms plus what was added:

| end to end, ms | agency % | ownership % | simultaneity % |
|---|---|---|---|
| 45 | 96 | 97.25 | 88 |
| 75 | 94.8 | 95.5 | 86.75 |
| 125 | 94 | 96.5 | 80.25 |
| 210 | 86.5 | 90 | 49.25 |
| 350 | 71.5 | 62 | 12.25 |

Between these values it is interpolated, beyond the last one constant. An item is answered with the
agreement of its aspect, mirrored if its wording is reversed. The spread of persons and items (0.5
and 0.7 scale points of 7) and two per cent less agreement for the foot are our own assumptions.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from app.science.simulation.goal import SimulationError

_BASE_MS = 45.0
_END_TO_END_MS = (45.0, 75.0, 125.0, 210.0, 350.0)
_PERSON_SPREAD, _ITEM_SPREAD = 0.5 / 6.0, 0.7 / 6.0
_FOOT_SHARE = 0.98


class Aspect(StrEnum):
    """The aspect of embodiment that an item asks about; it selects the curve of agreement."""

    AGENCY = "agency"
    OWNERSHIP = "ownership"
    SIMULTANEITY = "simultaneity"


_AGREEMENT = {
    Aspect.AGENCY: (0.96, 0.948, 0.94, 0.865, 0.715),
    Aspect.OWNERSHIP: (0.9725, 0.955, 0.965, 0.90, 0.62),
    Aspect.SIMULTANEITY: (0.88, 0.8675, 0.8025, 0.4925, 0.1225),
}


@dataclass(frozen=True)
class SimulatedItem:
    """The properties of an item needed to answer it: its key, the ends of its scale, its aspect."""

    key: str
    minimum: int
    maximum: int
    aspect: Aspect = Aspect.OWNERSHIP


def agreement(aspect: Aspect, latency_ms: float) -> float:
    """Return the published mean agreement, 0 to 1, at an added latency.

    Raises:
        SimulationError: the latency is below zero or not finite.
    """
    if not 0.0 <= latency_ms < float("inf"):
        raise SimulationError(f"A latency of {latency_ms} ms is not valid: zero or more is.")
    return float(np.interp(_BASE_MS + latency_ms, _END_TO_END_MS, _AGREEMENT[aspect]))


def simulated_answers(
    items: Sequence[SimulatedItem],
    direction: Mapping[str, int],
    latency_ms: float,
    limb: str,
    rng: np.random.Generator,
) -> dict[str, int]:
    """Return one simulated person's answers after one phase, by item key.

    Args:
        items: the items to answer, in order.
        direction: item key -> +1 where agreement speaks for embodiment, -1 where it speaks against
            it (reverse wording), 0 where it is unrelated (answered near the middle). Items that
            are not listed count as +1.
        latency_ms: added latency of the phase.
        limb: "hand" or "foot".
        rng: random generator of the spread between persons and items.

    Raises:
        SimulationError: the limb, direction or latency is invalid, or the minimum of a scale is not
            below its maximum.
    """
    if limb not in {"hand", "foot"}:
        raise SimulationError(f"Limb {limb!r} is not valid: use 'hand' or 'foot'.")
    person = _PERSON_SPREAD * rng.standard_normal()
    share = _FOOT_SHARE if limb == "foot" else 1.0
    answers = {}
    for item in items:
        towards = direction.get(item.key, 1)
        if towards not in {-1, 0, 1} or item.minimum >= item.maximum:
            raise SimulationError(
                f"Item {item.key!r} has direction {towards} and scale {item.minimum} to"
                f" {item.maximum}: a direction is -1, 0 or 1, a minimum below its maximum."
            )
        level = share * agreement(item.aspect, latency_ms) + person
        level = 0.5 + towards * (level - 0.5) + _ITEM_SPREAD * rng.standard_normal()
        answer = round(item.minimum + level * (item.maximum - item.minimum))
        answers[item.key] = min(max(answer, item.minimum), item.maximum)
    return answers
