"""Doubt answers that are valid one by one, but hardly as a whole: reversed items, another scale.

A file may have reversed its reverse-keyed items already, which the formulas then reverse once more;
and answers of 1 to 5 are valid on a scale of 1 to 7. Nothing is corrected, since only the person
who has the questionnaire knows: each doubt is a sentence that says what speaks for it.
"""

from collections import Counter
from collections.abc import Mapping, Sequence

import numpy as np

from app.science.instruments.instrument import Instrument
from app.science.instruments.scoring import scores_of_columns

_MIN_FORMS = 8
_AGAINST = 0.2
_CLEARLY = 1.64
"""In standard errors of a correlation of none: one in twenty is larger by chance."""
_MANY_ANSWERS = 200
_MOST_STEPS = 11
"""On longer scales nobody misses single steps."""
_PILED_UP = 0.5
"""Share of the usual step's answers that the outermost step has, at least, where a scale ends."""


def reversed_items(instrument: Instrument) -> dict[str, tuple[str, list[str]]]:
    """Return the items that a formula reverses: item -> the score and the items that it adds.

    They are found by evaluating the formulas: a higher answer to such an item lowers the score.
    """
    scaled = {
        item.key: scale
        for item in instrument.items
        if item.is_numeric and (scale := instrument.scale_of(item)) is not None
    }
    if not scaled:
        return {}
    keys = list(scaled)
    middle = np.array([(one.minimum + one.maximum) / 2 for one in scaled.values()])
    # In row 0 every item is at its middle; in row i + 1, item i is at its maximum.
    rows = np.tile(middle, (len(keys) + 1, 1))
    for at, one in enumerate(scaled.values()):
        rows[at + 1, at] = one.maximum
    columns = {key: rows[:, at] for at, key in enumerate(keys)}
    found: dict[str, tuple[str, list[str]]] = {}
    for score, values in scores_of_columns(instrument, columns, rows=len(rows)).items():
        slopes = values[1:] - values[0]
        up = [key for key, slope in zip(keys, slopes, strict=True) if slope > 0]
        for key, slope in zip(keys, slopes, strict=True):
            if slope < 0 and up:
                found.setdefault(key, (score, up))
    return found


def reversal_doubts(
    turning: Mapping[str, tuple[str, list[str]]], forms: Sequence[Mapping[str, object]]
) -> list[str]:
    """Return doubts about items that correlate positively with items that they should oppose.

    Args:
        turning: what `reversed_items` returns.
        forms: item -> answer; all but numbers are left out, and NaN is a missing answer.
    """
    doubts = []
    for item, (score, up) in turning.items():
        rows = [
            (own, float(np.mean(rest)))
            for form in forms
            if (own := _number(form.get(item))) is not None
            and (rest := [value for key in up if (value := _number(form.get(key))) is not None])
        ]
        if len(rows) < _MIN_FORMS:
            continue
        answers, others = np.array(rows).T
        if np.ptp(answers) and np.ptp(others):
            r = float(np.corrcoef(answers, others)[0, 1])
            if r > max(_AGAINST, _CLEARLY / (len(rows) - 1) ** 0.5):
                doubts.append(
                    f"{item} is reversed in {score}, but correlates with its other items"
                    f" (r = {r:.2f})"
                )
    return doubts


def scale_doubts(instrument: Instrument, forms: Sequence[Mapping[str, object]]) -> list[str]:
    """Return doubts about scales whose end hundreds of answers never reach, though they pile up.

    Where agreement is rare the outermost answers are rare, too; where the questionnaire's scale
    was shorter, its last step is used as much as others.
    """
    used: dict[tuple[int, int, int], Counter[float]] = {}
    names: dict[tuple[int, int, int], list[str]] = {}
    for item in instrument.items:
        scale = instrument.scale_of(item)
        if scale is None or len(scale.steps) > _MOST_STEPS:
            continue
        answers = [value for form in forms if (value := _number(form.get(item.key))) is not None]
        if answers:
            ends = (scale.minimum, scale.maximum, scale.step)
            used.setdefault(ends, Counter()).update(answers)
            names.setdefault(ends, []).append(item.key)
    doubts = []
    for ends, counts in used.items():
        minimum, maximum, step = ends
        low, high, total = min(counts), max(counts), counts.total()
        enough = _PILED_UP * total / len(counts)
        starts_late = low == minimum + step and counts[low] >= enough
        ends_early = high < maximum and counts[high] >= enough
        if total < _MANY_ANSWERS or low == high or not (starts_late or ends_early):
            continue
        own = names[ends]
        items = own[0] if len(own) == 1 else f"{own[0]} to {own[-1]}"
        doubts.append(
            f"all {total} answers to {items} are {low:g} to {high:g}, on a scale of"
            f" {minimum} to {maximum}: was the questionnaire's scale another one?"
        )
    return doubts


def _number(answer: object) -> float | None:
    return answer if isinstance(answer, float) and answer == answer else None
