"""Tests of the curves that simulated answers follow: named, never guessed from scores."""

import json
from typing import Any

import numpy as np
import pytest

from app.protocol import load_instrument
from app.rehearsal.answers import aspects_named, fill_in
from app.science.simulation import Aspect, agreement
from app.simulated_people.body import make_person
from tests.protocol.helpers import CONFIGS, STUDY, loaded, problems

_PEOPLE = 200
_NAMES = "simulation:\n  aspects:\n    karas2020: {q13: simultaneity, q6: agency}\n"


def _as_sent(key: str) -> dict[str, Any]:
    """Return an instrument as the tablet receives it."""
    text = (CONFIGS / "instruments" / f"{key}.yaml").read_text(encoding="utf-8")
    sent: dict[str, Any] = json.loads(load_instrument(text).canonical_json)
    return sent


def _means(latency_ms: float, aspects: dict[str, dict[str, Aspect]]) -> dict[str, float]:
    """Return the mean agreement, 0 to 1, of many simulated people with each item."""
    instrument = _as_sent("karas2020")
    likert = [item["key"] for item in instrument["items"] if item["type"] == "likert"]
    person = make_person(np.random.default_rng(1), None)
    answers = [
        fill_in(
            instrument,
            person,
            latency_ms,
            "hand",
            np.random.default_rng(seed),
            aspects.get("karas2020"),
        )
        for seed in range(_PEOPLE)
    ]
    return {key: float(np.mean([one[key] for one in answers]) - 1.0) / 6.0 for key in likert}


@pytest.mark.parametrize("latency_ms", [0.0, 165.0, 305.0])
def test_the_item_of_simultaneity_follows_its_published_curve(latency_ms: float) -> None:
    """The shipped item of simultaneity, which no score contains, follows Waltemate's curve."""
    found = _means(latency_ms, aspects_named(None))
    for item, aspect in (("q14", Aspect.SIMULTANEITY), ("q6", Aspect.AGENCY)):
        # Answers are whole and end at the ends of the scale, which takes a little off the means.
        assert found[item] == pytest.approx(agreement(aspect, latency_ms), abs=0.06)
    assert found["q1"] == pytest.approx(agreement(Aspect.OWNERSHIP, latency_ms), abs=0.06)


def test_what_the_study_names_takes_the_place_of_the_usual_names() -> None:
    """Named by the study, q13 follows simultaneity; what it does not name follows ownership."""
    protocol = json.loads(loaded(STUDY + _NAMES).canonical_json)
    found = _means(305.0, aspects_named(protocol))
    assert found["q13"] < 0.2
    assert found["q6"] == pytest.approx(agreement(Aspect.AGENCY, 305.0), abs=0.06)
    for item in ("q7", "q14"):
        assert found[item] == pytest.approx(agreement(Aspect.OWNERSHIP, 305.0), abs=0.06)


def test_no_curve_is_guessed_from_the_name_of_a_score() -> None:
    """An instrument of the lab's own whose score is called agency follows ownership if unnamed."""
    assert "own" not in aspects_named(json.loads(loaded().canonical_json))


def test_a_study_without_names_keeps_its_hash() -> None:
    """The names belong to the content; a study without them has the same content as before."""
    assert "simulation" not in json.loads(loaded().canonical_json)
    assert loaded(STUDY + _NAMES).content_hash != loaded().content_hash


@pytest.mark.parametrize(
    ("old", "new", "path", "words"),
    [
        ("karas2020", "veq", "simulation.aspects.veq", "does not ask 'veq'"),
        ("q13", "q99", "simulation.aspects.karas2020.q99", "no Likert item 'q99'"),
        ("q13", "problems", "simulation.aspects.karas2020.problems", "no Likert item"),
        ("simultaneity", "presence", "simulation.aspects.karas2020.q13", "presence"),
    ],
)
def test_names_of_what_is_not_asked_are_refused(old: str, new: str, path: str, words: str) -> None:
    """An instrument or item that the study does not ask, or an unknown aspect, is refused."""
    found = problems(STUDY + _NAMES.replace(old, new))
    assert path in {one.path for one in found}
    assert any(words in f"{one.message} {one.value}" for one in found)
