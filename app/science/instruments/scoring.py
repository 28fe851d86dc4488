"""Scores from the instrument's own formulas."""

import math
from collections.abc import Mapping

import numpy as np

from app.science.instruments.answers import as_number
from app.science.instruments.errors import AnswerError
from app.science.instruments.evaluation import FloatArray, evaluate
from app.science.instruments.instrument import Instrument


def score_answers(instrument: Instrument, answers: Mapping[str, object]) -> dict[str, float | None]:
    """Every score of one filled-in form, in the instrument's order; None where it has no value.

    `answers`: raw, as answered (before recoding). Texts and choices are ignored. A score is None if
    one of its items is missing or a division by zero occurs.
    Raises AnswerError for an answer off its scale and for a key that is no item.
    """
    unknown = [key for key in answers if key not in instrument.by_key]
    if unknown:
        valid = "an answer to one of the items " + ", ".join(instrument.by_key)
        raise AnswerError(unknown[0], answers[unknown[0]], valid)
    columns = {
        item.key: np.array([as_number(instrument, item, answers.get(item.key))])
        for item in instrument.items
        if item.is_numeric
    }
    scores = scores_of_columns(instrument, columns, rows=1)
    return {
        key: None if math.isnan(column[0]) else float(column[0]) for key, column in scores.items()
    }


def scores_of_columns(
    instrument: Instrument, columns: Mapping[str, FloatArray], *, rows: int
) -> dict[str, FloatArray]:
    """Raw answers (rows,) by item -> scores (rows,); items that are absent count as missing."""
    missing = np.full(rows, np.nan)
    raw = {item.key: columns.get(item.key, missing) for item in instrument.items if item.is_numeric}
    values = _recoded(instrument, raw)
    scores: dict[str, FloatArray] = {}
    for key, tree in instrument.formulas.items():
        scores[key] = np.broadcast_to(evaluate(tree, values | scores), rows)
    return scores


def _recoded(instrument: Instrument, raw: dict[str, FloatArray]) -> dict[str, FloatArray]:
    """All items at once: the formula is the same for each."""
    if instrument.recoding is None or not raw:
        return raw
    together = np.stack(list(raw.values()))
    recoded = np.broadcast_to(evaluate(instrument.recoding, {"x": together}), together.shape)
    return dict(zip(raw, recoded, strict=True))
