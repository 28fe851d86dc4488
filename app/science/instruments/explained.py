"""The scoring of one form, step by step, so that a person can verify it by hand."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from app.science.instruments.answers import as_number
from app.science.instruments.formula import names_in
from app.science.instruments.instrument import Instrument
from app.science.instruments.items import Score
from app.science.instruments.scoring import evaluate, score_answers
from app.science.instruments.tokens import tokenize


@dataclass(frozen=True)
class ExplainedItem:
    """The value of a numeric item, as answered and after recoding; None if it was not answered."""

    key: str
    raw: float | None
    recoded: float | None


@dataclass(frozen=True)
class ExplainedScore:
    """A score, its formula with values in place of names, and its unanswered items."""

    score: Score
    filled_in: str
    value: float | None
    missing: tuple[str, ...]


@dataclass(frozen=True)
class ExplainedScoring:
    """All steps from answers to scores, in the instrument's order."""

    items: tuple[ExplainedItem, ...]
    scores: tuple[ExplainedScore, ...]


def explain_scoring(instrument: Instrument, answers: Mapping[str, object]) -> ExplainedScoring:
    """Return the steps by which raw `answers` become scores.

    The values are those of `score_answers`; raises AnswerError as it does.
    """
    values = score_answers(instrument, answers)
    items = tuple(
        _item(instrument, item.key, as_number(instrument, item, answers.get(item.key)))
        for item in instrument.items
        if item.is_numeric
    )
    all_values = {item.key: item.recoded for item in items} | values
    unanswered: dict[str, tuple[str, ...]] = {
        item.key: () if item.raw is not None else (item.key,) for item in items
    }
    scores: list[ExplainedScore] = []
    for score in instrument.scores:
        needed = names_in(instrument.formulas[score.key])
        missing = {name for key in needed for name in unanswered[key]}
        in_order = tuple(item.key for item in items if item.key in missing)
        unanswered[score.key] = in_order
        filled_in = _filled_in(score.formula, all_values)
        scores.append(ExplainedScore(score, filled_in, values[score.key], in_order))
    return ExplainedScoring(items, tuple(scores))


def _item(instrument: Instrument, key: str, raw: float) -> ExplainedItem:
    if math.isnan(raw):
        return ExplainedItem(key, None, None)
    recoding = instrument.recoding
    recoded = raw if recoding is None else float(evaluate(recoding, {"x": np.array([raw])})[0])
    return ExplainedItem(key, raw, None if math.isnan(recoded) else recoded)


def _filled_in(formula: str, all_values: Mapping[str, float | None]) -> str:
    """Return the formula with each name replaced by its value; a question mark if it is missing."""
    pieces: list[str] = []
    at = 0
    for token in tokenize(formula)[:-1]:
        pieces.append(formula[at : token.position])
        at = token.position + len(token.text)
        pieces.append(_number(all_values[token.text]) if token.text in all_values else token.text)
    return "".join([*pieces, formula[at:]])


def _number(value: float | None) -> str:
    if value is None:
        return "?"
    text = f"{value:.6g}"
    return f"({text})" if value < 0 else text
