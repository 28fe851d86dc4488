"""A questionnaire with its scoring, as values: what is asked, how, and what it adds up to.

An *instrument* is a list of *items*. Likert items share the instrument's *scale* or have one of
their own; other items carry their own type and range. Before scoring, `recode` is applied to every
number ("x - 4" turns 1..7 into -3..+3), then each *score* is a formula over items and earlier
scores. A score has no value as soon as one of its items has none.

Texts are given in every language the instrument declares: `{"en": ..., "de": ...}`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import ClassVar, Literal

from app.science.instruments.definition import check_definition
from app.science.instruments.formula import Node, names_in, parse_formula

Text = Mapping[str, str]
"""Language code -> wording. Every declared language is present."""

ItemType = Literal["likert", "integer", "number", "text", "boolean", "choice"]
Answer = float | int | str | bool | None
"""What can be answered; None for an item that was left out."""

# Read by pydantic when an instrument file is loaded: nothing unknown, nothing converted silently.
_STRICT: dict[str, object] = {"extra": "forbid", "strict": True, "allow_inf_nan": False}


@dataclass(frozen=True)
class Choice:
    """One option of a choice item; `key` is what is stored."""

    __pydantic_config__: ClassVar[dict[str, object]] = _STRICT

    key: str
    label: Text


@dataclass(frozen=True)
class Scale:
    """The scale of likert items: whole numbers, with labels from lowest to highest.

    `step`: from one to the next. `labels`: one for each step, or two for both ends, or none.
    """

    __pydantic_config__: ClassVar[dict[str, object]] = _STRICT

    minimum: int
    maximum: int
    labels: tuple[Text, ...]
    step: int = 1

    @property
    def steps(self) -> range:
        """Every possible answer, from lowest to highest; empty if `step` is not positive."""
        return range(self.minimum, self.maximum + 1, self.step) if self.step > 0 else range(0)


@dataclass(frozen=True)
class Item:
    """One question.

    `minimum`, `maximum`: limits of integer and number items, in `unit`. `scale`: of a likert item,
    in place of the instrument's. `max_length`: characters of a text answer. `reverse_keyed`:
    agreement speaks against what the item's scale measures (used for reliability, never by the
    formulas). `note`: where the item comes from.
    """

    __pydantic_config__: ClassVar[dict[str, object]] = _STRICT

    key: str
    text: Text
    type: ItemType
    required: bool = True
    minimum: float | None = None
    maximum: float | None = None
    unit: str | None = None
    choices: tuple[Choice, ...] = ()
    max_length: int | None = None
    reverse_keyed: bool = False
    note: str | None = None
    scale: Scale | None = None

    @property
    def is_numeric(self) -> bool:
        """Whether a formula can use the item; a yes counts 1 and a no 0."""
        return self.type in ("likert", "integer", "number", "boolean")


@dataclass(frozen=True)
class Score:
    """A formula with a name. `minimum`, `maximum`: the range that its author states."""

    __pydantic_config__: ClassVar[dict[str, object]] = _STRICT

    key: str
    label: Text
    formula: str
    minimum: float | None = None
    maximum: float | None = None
    note: str | None = None


@dataclass(frozen=True)
class Provenance:
    """Where a text or an instrument comes from, and how far that was checked."""

    __pydantic_config__: ClassVar[dict[str, object]] = _STRICT

    source: str
    licence: str
    verified: str
    notes: tuple[str, ...] = ()


@dataclass(frozen=True)
class Instrument:
    """A questionnaire. That it exists proves that it is consistent and its formulas readable.

    `stem`: the words before each likert item. `shuffle`: ask the items in random order, but those
    in `last` at the end, as listed. Raises InstrumentDefinitionError with every contradiction.
    """

    __pydantic_config__: ClassVar[dict[str, object]] = _STRICT

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
        """Items by their key."""
        return {item.key: item for item in self.items}

    def scale_of(self, item: Item) -> Scale | None:
        """The scale on which a likert item is answered; None for other items."""
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
        """The parsed recoding of a raw number `x`; None to take answers as they are."""
        return None if self.recode is None else parse_formula(self.recode, {"x"})

    @cached_property
    def scored_items(self) -> frozenset[str]:
        """Keys of the items that enter at least one score."""
        used = frozenset[str]().union(*(names_in(tree) for tree in self.formulas.values()))
        return used & self.by_key.keys()
