"""Questionnaires with their scoring: what is asked, which answers fit, what they add up to."""

from app.science.instruments.answers import (
    AnswerProblem,
    fits,
    valid_answers,
    validate_answers,
)
from app.science.instruments.errors import (
    AnswerError,
    DefinitionProblem,
    FormulaError,
    InstrumentDefinitionError,
    InstrumentError,
    InstrumentTableError,
)
from app.science.instruments.instrument import Instrument, item_order
from app.science.instruments.items import (
    Answer,
    Choice,
    Item,
    ItemType,
    Provenance,
    Scale,
    Score,
    Text,
)
from app.science.instruments.scoring import score_answers

__all__ = [
    "Answer",
    "AnswerError",
    "AnswerProblem",
    "Choice",
    "DefinitionProblem",
    "FormulaError",
    "Instrument",
    "InstrumentDefinitionError",
    "InstrumentError",
    "InstrumentTableError",
    "Item",
    "ItemType",
    "Provenance",
    "Scale",
    "Score",
    "Text",
    "fits",
    "item_order",
    "score_answers",
    "valid_answers",
    "validate_answers",
]
