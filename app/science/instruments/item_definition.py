"""Whether one item is consistent: each type has its own fields, and needs some of them."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from app.science.instruments.errors import DefinitionProblem

if TYPE_CHECKING:
    from app.science.instruments.model import Item

_Path = tuple[str | int, ...]

MAX_TEXT_LENGTH = 10_000
DEFAULT_TEXT_LENGTH = 4_000


def item_problems(item: "Item", path: _Path, *, has_scale: bool) -> Iterator[DefinitionProblem]:
    """Every contradiction within one item; `path` leads to the item."""
    yield from _misplaced(item, path)
    yield from _range(item, path)
    yield from _choices(item, path)
    if item.type == "likert" and not has_scale:
        yield DefinitionProblem(
            (*path, "type"),
            "A likert item needs a scale, its own or the instrument's, and there is none.",
            item.type,
            remedy="Add a scale to the instrument or the item, or give the item another type.",
        )
    length = item.max_length
    if length is not None and not 1 <= length <= MAX_TEXT_LENGTH:
        yield DefinitionProblem(
            (*path, "max_length"),
            "This length is out of range.",
            length,
            f"1 to {MAX_TEXT_LENGTH} characters",
            f"Write for example {DEFAULT_TEXT_LENGTH}.",
        )


def _misplaced(item: "Item", path: _Path) -> Iterator[DefinitionProblem]:
    """Fields that this type of item ignores: better refused than silently without effect."""
    ranged = ("integer", "number")
    fields = (
        ("minimum", item.minimum is not None, ranged),
        ("maximum", item.maximum is not None, ranged),
        ("unit", item.unit is not None, ranged),
        ("choices", bool(item.choices), ("choice",)),
        ("max_length", item.max_length is not None, ("text",)),
        ("reverse_keyed", item.reverse_keyed, ("likert",)),
        ("scale", item.scale is not None, ("likert",)),
    )
    for field, given, types in fields:
        if given and item.type not in types:
            yield DefinitionProblem(
                (*path, field),
                f"{field} has no meaning for an item of type {item.type}.",
                item.type,
                types,
                f"Leave {field} out.",
            )


def _range(item: "Item", path: _Path) -> Iterator[DefinitionProblem]:
    low, high = item.minimum, item.maximum
    if low is not None and high is not None and low >= high:
        yield DefinitionProblem(
            (*path, "maximum"),
            f"The range from {low} to {high} is empty.",
            high,
            f"> {low}",
            "Make maximum larger than minimum.",
        )


def _choices(item: "Item", path: _Path) -> Iterator[DefinitionProblem]:
    keys = [choice.key for choice in item.choices]
    if item.type == "choice" and len(keys) < 2:
        yield DefinitionProblem(
            (*path, "choices"),
            f"A choice item needs at least two choices and has {len(keys)}.",
            len(keys),
            ">= 2 choices",
            "Add choices, each with a key and a label.",
        )
    for index, key in enumerate(keys):
        if not key or len(key) > 40 or key in keys[:index]:
            yield DefinitionProblem(
                (*path, "choices", index, "key"),
                "This choice's key is empty, too long (over 40) or there twice.",
                key,
                remedy="Give each choice its own short key.",
            )
