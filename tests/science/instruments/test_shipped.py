"""Tests of the shipped instruments against hand-computed scores from their sources."""

from itertools import count

import pytest

from app.protocol import load_instrument, parse_instrument_json
from app.science.instruments import Instrument, Score, score_answers, validate_answers
from tests.science.instruments.helpers import CONFIGS, shipped

KEYS = sorted(path.stem for path in CONFIGS.glob("*.yaml"))
SCORED = [shipped(key) for key in KEYS if shipped(key).scores]


def numbered(values: str, key: str = "q") -> dict[str, object]:
    """Return answers to q1, q2, ... (or r1, r2, ...)."""
    return {f"{key}{at}": int(value) for at, value in zip(count(1), values.split(), strict=False)}


VECTORS: dict[str, list[tuple[dict[str, object], dict[str, float]]]] = {
    # Raw sums of 7 each; weights 9.54, 7.58, 13.92 and 3.74: 7 x 9.54 = 66.78, 21 x 3.74 = 78.54.
    "ssq": [
        (
            numbered("1 " * 16),
            {"nausea": 66.78, "oculomotor": 53.06, "disorientation": 97.44, "total": 78.54},
        ),
        (
            # Nausea belongs to two groups: 9.54, 13.92, and twice 3.74.
            numbered("0 0 0 0 0 0 0 1 0 0 0 0 0 0 0 0"),
            {"nausea": 9.54, "oculomotor": 0.0, "disorientation": 13.92, "total": 7.48},
        ),
        (
            numbered("3 " * 16),
            {"nausea": 200.34, "oculomotor": 159.18, "disorientation": 292.32, "total": 235.62},
        ),
    ],
    # Means of four: (7 + 6 + 5 + 6) / 4, (1 + 2 + 3 + 4) / 4, (1 + 1 + 2 + 1) / 4.
    "veq": [
        (
            numbered("7 6 5 6", "ownership")
            | numbered("1 2 3 4", "agency")
            | numbered("1 1 2 1", "change"),
            {"ownership": 6.0, "agency": 2.5, "change": 1.25},
        )
    ],
    # (1+2+3+4+5+6+2+2)/8, (4+6+7+1+2+1)/6, (5+3+4+5+6+7)/6, (3+5+6+7+1+2)/6, and their mean.
    "pgf2021": [
        (
            numbered("1 2 3 4 5 6 7 1 2 3 4 5 6 7 1 2", "r"),
            {
                "appearance": 3.125,
                "response": 3.5,
                "ownership": 5.0,
                "multi_sensory": 4.0,
                "embodiment": 3.90625,
            },
        )
    ],
    # Spatial: 4, 6-1, 3, 6, 2: 20 / 5; involved: 2, 3, 6-6, 5: 10 / 4; real: 6-2, 3, 1, 0: 8 / 4.
    "ipq": [
        (
            {"g1": 5}
            | numbered("4 1 3 6 2", "sp")
            | numbered("2 3 6 5", "inv")
            | numbered("2 3 1 0", "real"),
            {"general_presence": 5.0, "spatial_presence": 4.0, "involvement": 2.5, "realism": 2.0},
        )
    ],
    # (70 + 30 + 45 + 20 + 65 + 10) / 6 = 240 / 6.
    "raw_tlx": [
        (
            {
                "mental": 70,
                "physical": 30,
                "temporal": 45,
                "performance": 20,
                "effort": 65,
                "frustration": 10,
            },
            {"workload": 40.0},
        )
    ],
    "fms": [({"sickness": 13}, {"sickness_score": 13.0})],
    # Minus 4 each: 1, 2, 3, 0 give 6 / 4; -3, 0, -1, 2 give -2 / 4; all 4 / 8.
    "ueq_s": [
        (
            {
                "supportive": 5,
                "easy": 6,
                "efficient": 7,
                "clear": 4,
                "exciting": 1,
                "interesting": 4,
                "inventive": 3,
                "leading_edge": 6,
            },
            {"pragmatic": 1.5, "hedonic": -0.5, "overall": 0.5},
        )
    ],
}


@pytest.mark.parametrize(
    ("key", "answers", "scores"),
    [(key, *vector) for key, vectors in VECTORS.items() for vector in vectors],
)
def test_hand_computed_vectors(
    key: str, answers: dict[str, object], scores: dict[str, float]
) -> None:
    """Each vector's answers are valid and give the scores that were computed by hand."""
    instrument = shipped(key)
    assert validate_answers(instrument, answers) == ()
    assert score_answers(instrument, answers) == pytest.approx(scores, abs=1e-12)


def test_every_scored_instrument_has_a_vector() -> None:
    """Every scored instrument has a hand-computed vector, or tests of its own."""
    assert {instrument.key for instrument in SCORED} == {*VECTORS, "karas2020"}


@pytest.mark.parametrize(
    ("instrument", "score"),
    [(instrument, score) for instrument in SCORED for score in instrument.scores],
    ids=lambda value: value.key,
)
def test_stated_ranges_are_those_of_the_scales(instrument: Instrument, score: Score) -> None:
    """The stated range of every score is reached at the ends of its items' scales."""
    ends = {
        item.key: (scale.minimum, scale.maximum)
        for item in instrument.items
        if (scale := instrument.scale_of(item)) is not None
    }

    def value(answers: dict[str, int]) -> float:
        found = score_answers(instrument, answers)[score.key]
        assert found is not None
        return found

    lows = {key: low for key, (low, _) in ends.items()}
    rising = {key for key, (_, high) in ends.items() if value({**lows, key: high}) > value(lows)}
    highest = {key: high if key in rising else low for key, (low, high) in ends.items()}
    lowest = {key: low if key in rising else high for key, (low, high) in ends.items()}
    assert value(lowest) == pytest.approx(score.minimum, abs=1e-9)
    assert value(highest) == pytest.approx(score.maximum, abs=1e-9)


@pytest.mark.parametrize("key", KEYS)
def test_every_text_is_there_in_both_languages(key: str) -> None:
    """Every instrument has English and German texts, a source and a record of what was verified."""
    instrument = shipped(key)
    assert instrument.languages == ("en", "de")
    provenance = instrument.provenance
    assert all(
        text.strip() for text in (provenance.source, provenance.licence, provenance.verified)
    )


@pytest.mark.parametrize("key", KEYS)
def test_the_stored_form_gives_the_same_instrument(key: str) -> None:
    """The canonical form gives the same instrument back, including scales of single items."""
    loaded = load_instrument((CONFIGS / f"{key}.yaml").read_text(encoding="utf-8"))
    assert parse_instrument_json(loaded.canonical_json) == loaded.instrument


def test_the_hash_of_a_stored_instrument_stays() -> None:
    """Later optional fields do not change the hash of an instrument that does not use them."""
    text = (CONFIGS / "karas2020.yaml").read_text(encoding="utf-8")
    loaded = load_instrument(text)
    assert '"step"' not in loaded.canonical_json
    assert loaded.canonical_json.count('"scale"') == 1
