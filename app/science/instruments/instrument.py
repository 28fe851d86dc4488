"""A questionnaire with its scoring: its items, their scales, and the formulas of its scores.

An *instrument* is a list of *items*. Likert items share the instrument's *scale* or have one of
their own; other items have their own type and range. Before scoring, `recode` is applied to every
number ("x - 4" turns 1..7 into -3..+3), then each *score* is a formula over items and earlier
scores. A score has no value if any of its items has none.

Creating an instrument checks it and reports every inconsistency with its path.
"""

import re
from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar

import numpy as np

from app.science.instruments.errors import (
    DefinitionProblem,
    FormulaError,
    InstrumentDefinitionError,
)
from app.science.instruments.formula import Node, names_in, parse_formula
from app.science.instruments.item_checks import Path, item_problems, scale_problems, text_problems
from app.science.instruments.items import STRICT, Item, Provenance, Scale, Score, Text
from app.science.instruments.tokens import FUNCTIONS

_KEY = re.compile(r"[a-z][a-z0-9_]{0,39}")
_LANGUAGE = re.compile(r"[a-z]{2,3}(-[A-Z]{2})?")
_KEY_REMEDY = "Use lower-case letters, digits and _, beginning with a letter, at most 40 in all."


@dataclass(frozen=True)
class Instrument:
    """A questionnaire. Every instance is consistent, and its formulas can be parsed.

    `stem`: the words before each Likert item. `shuffle`: ask the items in random order, but those
    in `last` at the end, as listed. Raises InstrumentDefinitionError with every inconsistency.
    """

    __pydantic_config__: ClassVar[dict[str, object]] = STRICT

    key: str
    version: int
    title: Text
    languages: tuple[str, ...]
    items: tuple[Item, ...]
    provenance: Provenance
    stem: Text | None = None
    instructions: Text | None = None
    scale: Scale | None = None
    recode: str | None = None
    shuffle: bool = False
    last: tuple[str, ...] = ()
    scores: tuple[Score, ...] = ()

    def __post_init__(self) -> None:
        check_definition(self)

    @cached_property
    def by_key(self) -> dict[str, Item]:
        """The items of the instrument, by key."""
        return {item.key: item for item in self.items}

    def scale_of(self, item: Item) -> Scale | None:
        """Return the scale on which a Likert item is answered; None for other items."""
        return (item.scale or self.scale) if item.type == "likert" else None

    @cached_property
    def formulas(self) -> dict[str, Node]:
        """The parsed formula of each score, in the order in which they must be computed."""
        names = {item.key for item in self.items if item.is_numeric}
        trees: dict[str, Node] = {}
        for score in self.scores:
            trees[score.key] = parse_formula(score.formula, names)
            names.add(score.key)
        return trees

    @cached_property
    def recoding(self) -> Node | None:
        """The parsed recoding of a raw number `x`; None if answers are not recoded."""
        return None if self.recode is None else parse_formula(self.recode, {"x"})

    @cached_property
    def scored_items(self) -> frozenset[str]:
        """Keys of the items used by at least one score."""
        used = frozenset[str]().union(*(names_in(tree) for tree in self.formulas.values()))
        return used & self.by_key.keys()


def item_order(instrument: Instrument, seed: int) -> tuple[str, ...]:
    """Return the item keys in the order in which to show them.

    If the instrument shuffles, all items but those in `last` come in a random order drawn from
    PCG64 seeded with `seed` (>= 0); those in `last` follow as listed. Otherwise the order is that
    of the instrument, again with `last` at the end. Raises ValueError for a negative seed.
    """
    free = [item.key for item in instrument.items if item.key not in instrument.last]
    if instrument.shuffle:
        rng = np.random.Generator(np.random.PCG64(np.random.SeedSequence(seed)))
        free = [free[index] for index in rng.permutation(len(free))]
    return (*free, *instrument.last)


def check_definition(instrument: Instrument) -> None:
    """Raise InstrumentDefinitionError with every inconsistency of the instrument, if any."""
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
    """Return whether the text is a valid key of an item, a score or an instrument."""
    return _KEY.fullmatch(text) is not None


def _basics(instrument: Instrument) -> Iterator[DefinitionProblem]:
    if not is_key(instrument.key):
        yield DefinitionProblem(
            ("key",), "This is not a valid key.", instrument.key, remedy=_KEY_REMEDY
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
                "This is not a language code, or it is listed twice.",
                language,
                "two or three lower-case letters, such as en or de",
                "Name each language once by its code.",
            )


def _keys(instrument: Instrument) -> Iterator[DefinitionProblem]:
    """Yield a problem for each invalid or duplicate key; items and scores share one namespace."""
    taken: set[str] = {"x", *FUNCTIONS}
    groups: tuple[tuple[str, Iterable[str]], ...] = (
        ("items", (item.key for item in instrument.items)),
        ("scores", (score.key for score in instrument.scores)),
    )
    for group, keys in groups:
        for index, key in enumerate(keys):
            if not is_key(key):
                yield DefinitionProblem(
                    (group, index, "key"), "This is not a valid key.", key, remedy=_KEY_REMEDY
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


def _items(instrument: Instrument) -> Iterator[DefinitionProblem]:
    for index, item in enumerate(instrument.items):
        has_scale = instrument.scale_of(item) is not None
        yield from item_problems(item, ("items", index), has_scale=has_scale)
        yield from scale_problems(item.scale, ("items", index, "scale"))


def _last(instrument: Instrument) -> Iterator[DefinitionProblem]:
    item_keys = [item.key for item in instrument.items]
    counts = Counter(instrument.last)
    for index, key in enumerate(instrument.last):
        if key not in item_keys or counts[key] > 1:
            yield DefinitionProblem(
                ("last", index),
                f"{key!r} is not an item, or it is listed twice.",
                key,
                item_keys,
                "List each item that stays at the end once.",
            )


def _texts(instrument: Instrument) -> Iterator[DefinitionProblem]:
    for path, text in _texts_of(instrument):
        yield from text_problems(path, text, instrument.languages)


def _formulas(instrument: Instrument) -> Iterator[DefinitionProblem]:
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


def _texts_of(instrument: Instrument) -> Iterator[tuple[Path, Text]]:
    """Yield every text of an instrument with its path."""
    yield ("title",), instrument.title
    for field, text in (("stem", instrument.stem), ("instructions", instrument.instructions)):
        if text is not None:
            yield (field,), text
    for at, item in enumerate(instrument.items):
        yield ("items", at, "text"), item.text
        for number, choice in enumerate(item.choices):
            yield ("items", at, "choices", number, "label"), choice.label
        yield from _labels(item.scale, ("items", at, "scale"))
    yield from _labels(instrument.scale, ("scale",))
    for at, score in enumerate(instrument.scores):
        yield ("scores", at, "label"), score.label


def _labels(scale: Scale | None, path: Path) -> Iterator[tuple[Path, Text]]:
    for at, label in enumerate(() if scale is None else scale.labels):
        yield (*path, "labels", at), label
