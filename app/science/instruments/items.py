"""The components of an instrument: items with their scales and choices, and scores.

Texts are given in every language the instrument declares: `{"en": ..., "de": ...}`.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, Literal

Text = Mapping[str, str]
"""A text by language code. Every declared language is present."""

ItemType = Literal["likert", "integer", "number", "text", "boolean", "choice"]
Answer = float | int | str | bool | None
"""A value that can be answered; None for an item that was not answered."""

# Used by pydantic to load instrument files: unknown fields and implicit conversions are errors.
STRICT: dict[str, object] = {"extra": "forbid", "strict": True, "allow_inf_nan": False}


@dataclass(frozen=True)
class Choice:
    """One option of a choice item; `key` is what is stored."""

    __pydantic_config__: ClassVar[dict[str, object]] = STRICT

    key: str
    label: Text


@dataclass(frozen=True)
class Scale:
    """The scale of Likert items: whole numbers, with labels from lowest to highest.

    `step`: the difference between neighbouring numbers. `labels`: one for each step, or two for
    both ends, or none.
    """

    __pydantic_config__: ClassVar[dict[str, object]] = STRICT

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
    """One question or statement of an instrument.

    `minimum`, `maximum`: limits of integer and number items, in `unit`. `scale`: the scale of a
    Likert item, in place of the instrument's. `max_length`: the maximum number of characters of a
    text answer. `reverse_keyed`: agreement speaks against what the item's scale measures (used for
    reliability, never by the formulas). `note`: the origin of the item.
    """

    __pydantic_config__: ClassVar[dict[str, object]] = STRICT

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
    """A formula over items, with a name. `minimum`, `maximum`: the range stated by its author."""

    __pydantic_config__: ClassVar[dict[str, object]] = STRICT

    key: str
    label: Text
    formula: str
    minimum: float | None = None
    maximum: float | None = None
    note: str | None = None


@dataclass(frozen=True)
class Provenance:
    """The origin of a text or an instrument, and how far it was verified."""

    __pydantic_config__: ClassVar[dict[str, object]] = STRICT

    source: str
    licence: str
    verified: str
    notes: tuple[str, ...] = ()
