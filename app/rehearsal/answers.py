"""Fill in forms for the simulated participant: answers are drawn from the seed."""

from collections.abc import Mapping
from typing import Any, Final

import numpy as np

from app.science.simulation import Aspect, SimulatedItem, simulated_answers
from app.simulated_people.body import Person

OPEN_PROMPT = "Simulated answer of a rehearsal."
SIGNATURE = "M80 150L120 60L160 150M100 115L145 115M200 150L200 60L260 150L260 60"
"""A synthetic signature of two letters, as an SVG path."""


NAMED: Final[Mapping[str, Mapping[str, Aspect]]] = {
    "karas2020": {
        **dict.fromkeys(("q6", "q7", "q8", "q9"), Aspect.AGENCY),
        "q14": Aspect.SIMULTANEITY,
    },
    "veq": dict.fromkeys(("agency1", "agency2", "agency3", "agency4"), Aspect.AGENCY),
    "pgf2021": {"r13": Aspect.AGENCY},
}
"""The aspects of items of the product's own instruments, by what they ask; others: ownership."""


def aspects_named(protocol: Mapping[str, Any] | None) -> dict[str, dict[str, Aspect]]:
    """Return item -> aspect by instrument: those that the study names, else the product's own."""
    simulation = (protocol or {}).get("simulation") or {}
    named = {
        instrument: {item: Aspect(aspect) for item, aspect in items.items()}
        for instrument, items in simulation.get("aspects", {}).items()
    }
    return {**{key: dict(items) for key, items in NAMED.items()}, **named}


def agreement(form: dict[str, Any]) -> dict[str, Any]:
    """Return the simulated participant's consent, with all required statements ticked."""
    lines = enumerate(form["statements"])
    return {
        "ticked": [at for at, line in lines if not line["optional"]],
        "name": "Simulated participant" if form["signature"] == "typed" else None,
        "signature": SIGNATURE if form["signature"] == "drawn" else None,
    }


def fill_in(
    instrument: dict[str, Any],
    person: Person,
    latency_ms: float | None,
    limb: str | None,
    rng: np.random.Generator,
    aspects: Mapping[str, Aspect] | None = None,
) -> dict[str, Any]:
    """Return answers to every item of an instrument (as the tablet receives it).

    `aspects`: whose curve the answers to an item follow; those of other items follow ownership.
    """
    likert = [item for item in instrument["items"] if item["type"] == "likert"]
    answers: dict[str, Any] = {}
    if likert:
        curves = aspects or {}
        scales = {item["key"]: item.get("scale") or instrument["scale"] for item in likert}
        drawn = simulated_answers(
            [
                SimulatedItem(
                    key,
                    scale["minimum"],
                    scale["maximum"],
                    curves.get(key, Aspect.OWNERSHIP),
                )
                for key, scale in scales.items()
            ],
            {item["key"]: -1 if item["reverse_keyed"] else 1 for item in likert},
            latency_ms or 0.0,
            limb or "hand",
            rng,
        )
        answers |= {key: _on_step(value, scales[key]) for key, value in drawn.items()}
    for item in instrument["items"]:
        if item["type"] != "likert":
            answers[item["key"]] = _answer(item, person, rng)
    return answers


def _on_step(value: int, scale: dict[str, Any]) -> int:
    """Return the nearest step of a scale."""
    low, step = int(scale["minimum"]), int(scale.get("step", 1))
    return low + step * round((value - low) / step)


def _answer(item: dict[str, Any], person: Person, rng: np.random.Generator) -> Any:
    own = {
        "handedness": person.build.handedness,
        "footedness": person.build.footedness,
        "age": person.build.age,
        "height_cm": round(person.build.stature_m * 100),
        "weight_kg": round(person.build.mass_kg),
        "sex": person.build.sex,
    }
    if item["key"] in own:
        return own[item["key"]]
    match item["type"]:
        case "boolean":
            # Participants need normal or corrected vision and stereo vision.
            return item["key"] in ("vision", "stereo_vision")
        case "choice":
            keys = [choice["key"] for choice in item["choices"]]
            return keys[int(rng.integers(len(keys)))]
        case "integer" | "number":
            return int(rng.integers(int(item["minimum"] or 0), int(item["maximum"] or 10) + 1))
        case _:
            return OPEN_PROMPT if item["required"] or rng.random() < 0.5 else None
