"""Find scales that seem to be numbered differently, and items that seem to be reversed already."""

from collections.abc import Mapping as Map
from collections.abc import Sequence

import numpy as np

from app.features.results.imports.applying import Form
from app.features.results.imports.schemas import Shift
from app.science.instruments import Instrument, scores_of_columns

_MIN_FORMS = 8
_AGAINST = 0.2


def shift_of(instrument: Instrument, numbers: Map[str, Sequence[float]]) -> Shift | None:
    """Return the conversion to the scale if the file seems to count its steps from 0 or 1."""
    found = []
    for key, values in numbers.items():
        scale = instrument.scale_of(instrument.by_key[key])
        if scale is not None and values:
            found.append((scale, min(values), max(values), all(v.is_integer() for v in values)))
    if not found or not all(whole for *_, whole in found):
        return None
    scale = found[0][0]
    if any((one.minimum, one.maximum, one.step) != (scale.minimum, scale.maximum, scale.step)
           for one, *_ in found):  # fmt: skip
        return None
    low, high = min(low for _, low, _, _ in found), max(high for _, _, high, _ in found)
    n = len(scale.steps)
    for start in (1, 0):
        multiply, add = float(scale.step), float(scale.minimum - scale.step * start)
        if (multiply, add) != (1.0, 0.0) and start <= low and high <= n - 1 + start:
            why = (
                f"The numbers range from {low:g} to {high:g}; the scale has {n} steps from "
                f"{scale.minimum} to {scale.maximum}. The file may count the steps from {start}."
            )
            return Shift(multiply=multiply, add=add, why=why)
    return None


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


def reversal_notes(turning: Map[str, tuple[str, list[str]]], forms: Sequence[Form]) -> list[str]:
    """Return notes on items that correlate positively with items that they should oppose."""
    notes = []
    for item, (score, up) in turning.items():
        rows = [
            (float(one), float(np.mean(rest)))
            for form in forms
            if isinstance(one := form.answers.get(item), float)
            and (rest := [v for key in up if isinstance(v := form.answers.get(key), float)])
        ]
        if len(rows) < _MIN_FORMS:
            continue
        own, others = np.array(rows).T
        if np.ptp(own) and np.ptp(others):
            r = float(np.corrcoef(own, others)[0, 1])
            if r > _AGAINST:
                notes.append(
                    f"{item} is reversed in {score}, but correlates with its other items "
                    f"(r = {r:.2f}). If the file has already reversed it, mark it as reversed."
                )
    return notes
