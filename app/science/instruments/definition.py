"""Whether an instrument is consistent: every contradiction is found, each with its place."""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from app.science.instruments.errors import (
    DefinitionProblem,
    FormulaError,
    InstrumentDefinitionError,
)
from app.science.instruments.formula import parse_formula
from app.science.instruments.item_definition import item_problems
from app.science.instruments.scale_definition import scale_problems
from app.science.instruments.texts import text_problems, texts_of
from app.science.instruments.tokens import FUNCTIONS

if TYPE_CHECKING:
    from app.science.instruments.model import Instrument

_KEY = re.compile(r"[a-z][a-z0-9_]{0,39}")
_LANGUAGE = re.compile(r"[a-z]{2,3}(-[A-Z]{2})?")
_KEY_REMEDY = "Use lower-case letters, digits and _, beginning with a letter, at most 40 in all."


def check_definition(instrument: "Instrument") -> None:
    """Raise InstrumentDefinitionError with every contradiction of the instrument, if any."""
    problems = (
        *_basics(instrument),
        *_keys(instrument),
        *_items(instrument),
        *scale_problems(instrument.scale, ("scale",)),
        *_last(instrument),
        *_formulas(instrument),
        *_texts(instrument),
    )
    if problems:
        raise InstrumentDefinitionError(problems)


def is_key(text: str) -> bool:
    """Whether the text can name an item, a score or an instrument."""
    return _KEY.fullmatch(text) is not None


def _basics(instrument: "Instrument") -> Iterator[DefinitionProblem]:
    if not is_key(instrument.key):
        yield DefinitionProblem(
            ("key",), "This cannot be a key.", instrument.key, remedy=_KEY_REMEDY
        )
    if instrument.version < 1:
        yield DefinitionProblem(
            ("version",), "Versions count from 1.", instrument.version, ">= 1", "Write 1."
        )
    if not instrument.items:
        yield DefinitionProblem(("items",), "There is no item.", remedy="Add at least one item.")
    if not instrument.languages:
        yield DefinitionProblem(
            ("languages",), "No language is declared.", remedy="Write for example [en, de]."
        )
    for index, language in enumerate(instrument.languages):
        if not _LANGUAGE.fullmatch(language) or language in instrument.languages[:index]:
            yield DefinitionProblem(
                ("languages", index),
                "This is not a language code, or it is there twice.",
                language,
                "two or three lower-case letters, such as en or de",
                "Name each language once by its code.",
            )


def _keys(instrument: "Instrument") -> Iterator[DefinitionProblem]:
    """Items and scores share one name space, because formulas do."""
    taken: set[str] = {"x", *FUNCTIONS}
    groups: tuple[tuple[str, Iterable[str]], ...] = (
        ("items", (item.key for item in instrument.items)),
        ("scores", (score.key for score in instrument.scores)),
    )
    for group, keys in groups:
        for index, key in enumerate(keys):
            if not is_key(key):
                yield DefinitionProblem(
                    (group, index, "key"), "This cannot be a key.", key, remedy=_KEY_REMEDY
                )
            elif key in taken:
                yield DefinitionProblem(
                    (group, index, "key"),
                    f"The name {key} is taken.",
                    key,
                    "a name that no other item, score or function has",
                    "Give it another key.",
                )
            taken.add(key)


def _items(instrument: "Instrument") -> Iterator[DefinitionProblem]:
    for index, item in enumerate(instrument.items):
        has_scale = instrument.scale_of(item) is not None
        yield from item_problems(item, ("items", index), has_scale=has_scale)
        yield from scale_problems(item.scale, ("items", index, "scale"))


def _last(instrument: "Instrument") -> Iterator[DefinitionProblem]:
    known = [item.key for item in instrument.items]
    counts = Counter(instrument.last)
    for index, key in enumerate(instrument.last):
        if key not in known or counts[key] > 1:
            yield DefinitionProblem(
                ("last", index),
                f"{key!r} is not an item, or it is listed twice.",
                key,
                known,
                "List each item that stays at the end once.",
            )


def _texts(instrument: "Instrument") -> Iterator[DefinitionProblem]:
    for path, text in texts_of(instrument):
        yield from text_problems(path, text, instrument.languages)


def _formulas(instrument: "Instrument") -> Iterator[DefinitionProblem]:
    if instrument.recode is not None:
        yield from _formula(("recode",), instrument.recode, {"x"})
    names = {item.key for item in instrument.items if item.is_numeric}
    for index, score in enumerate(instrument.scores):
        yield from _formula(("scores", index, "formula"), score.formula, names)
        names.add(score.key)
        low, high = score.minimum, score.maximum
        if low is not None and high is not None and low >= high:
            yield DefinitionProblem(
                ("scores", index, "maximum"),
                f"The range from {low} to {high} is empty.",
                high,
                f"> {low}",
                "Make maximum larger than minimum.",
            )


def _formula(
    path: tuple[str | int, ...], text: str, names: set[str]
) -> Iterator[DefinitionProblem]:
    try:
        parse_formula(text, names)
    except FormulaError as error:
        message = f"{error.message} (character {error.position + 1})."
        yield DefinitionProblem(path, message, text, sorted(names), error.remedy)
