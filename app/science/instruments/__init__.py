"""Questionnaires: their items, which answers are valid, and how scores are computed.

An `Instrument` is checked when it is created, so every instance is consistent. Tables of answers
are read by `instruments.table`, which loads pandas.
"""

from app.science.instruments.answers import (
    USUAL_MISSING_CODES,
    fits,
    straight_lined,
    valid_answers,
    validate_answers,
)
from app.science.instruments.doubts import reversal_doubts, reversed_items, scale_doubts
from app.science.instruments.errors import (
    AnswerError,
    DefinitionProblem,
    FormulaError,
    InstrumentDefinitionError,
    InstrumentError,
    InstrumentTableError,
    shortened,
)
from app.science.instruments.explained import ExplainedScore, explain_scoring
from app.science.instruments.formula import names_in
from app.science.instruments.instrument import Instrument, is_key, item_order
from app.science.instruments.item_checks import text_problems
from app.science.instruments.items import Choice, Item, Provenance, Scale, Score, Text
from app.science.instruments.scoring import score_answers, scores_of_columns

__all__ = [
    "USUAL_MISSING_CODES",
    "AnswerError",
    "Choice",
    "DefinitionProblem",
    "ExplainedScore",
    "FormulaError",
    "Instrument",
    "InstrumentDefinitionError",
    "InstrumentError",
    "InstrumentTableError",
    "Item",
    "Provenance",
    "Scale",
    "Score",
    "Text",
    "explain_scoring",
    "fits",
    "is_key",
    "item_order",
    "names_in",
    "reversal_doubts",
    "reversed_items",
    "scale_doubts",
    "score_answers",
    "scores_of_columns",
    "shortened",
    "straight_lined",
    "text_problems",
    "valid_answers",
    "validate_answers",
]
