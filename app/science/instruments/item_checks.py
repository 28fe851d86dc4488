"""Checks that an item, its scale and its texts are consistent.

Each type of item has its own fields, some of them required; a scale has ends, steps and labels; a
text must exist in every language that the instrument declares.
"""

from collections.abc import Iterable, Iterator, Mapping

from app.science.instruments.errors import DefinitionProblem
from app.science.instruments.items import Item, Scale

Path = tuple[str | int, ...]

MAX_TEXT_LENGTH = 10_000
DEFAULT_TEXT_LENGTH = 4_000
MAX_STEPS = 101


def item_problems(item: Item, path: Path, *, has_scale: bool) -> Iterator[DefinitionProblem]:
    """Yield every inconsistency within one item; `path` is the path of the item."""
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


def _misplaced(item: Item, path: Path) -> Iterator[DefinitionProblem]:
    """Yield a problem for each field that this type of item would silently ignore."""
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


def _range(item: Item, path: Path) -> Iterator[DefinitionProblem]:
    low, high = item.minimum, item.maximum
    if low is not None and high is not None and low >= high:
        yield DefinitionProblem(
            (*path, "maximum"),
            f"The range from {low} to {high} is empty.",
            high,
            f"> {low}",
            "Make maximum larger than minimum.",
        )


def _choices(item: Item, path: Path) -> Iterator[DefinitionProblem]:
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
                "This choice's key is empty, too long (over 40) or used twice.",
                key,
                remedy="Give each choice its own short key.",
            )


def scale_problems(scale: Scale | None, path: Path) -> Iterator[DefinitionProblem]:
    """Yield every inconsistency within a scale; none for None. `path` is the path of the scale."""
    if scale is None:
        return
    count = len(scale.steps)
    if scale.step < 1:
        yield DefinitionProblem(
            (*path, "step"), "A step must be a whole number.", scale.step, ">= 1", "Write 1."
        )
    elif not 2 <= count <= MAX_STEPS:
        yield DefinitionProblem(
            (*path, "maximum"),
            f"A scale from {scale.minimum} to {scale.maximum} has {count} steps.",
            scale.maximum,
            f"2 to {MAX_STEPS} steps",
            "Make maximum larger than minimum.",
        )
    elif scale.steps[-1] != scale.maximum:
        yield DefinitionProblem(
            (*path, "step"),
            f"Steps of {scale.step} from {scale.minimum} do not reach {scale.maximum}.",
            scale.step,
            f"a divisor of {scale.maximum - scale.minimum}",
            "Choose a step that leads from minimum to maximum.",
        )
    elif len(scale.labels) not in (0, 2, count):
        yield DefinitionProblem(
            (*path, "labels"),
            f"There are {len(scale.labels)} labels for {count} steps.",
            len(scale.labels),
            f"{count} labels, 2 (for both ends) or none",
            "Give one label for each step from lowest to highest, or only those of both ends.",
        )


def text_problems(
    path: Path, text: Mapping[str, str], languages: Iterable[str]
) -> Iterator[DefinitionProblem]:
    """Yield a problem for each declared language in which the text at `path` is missing or blank.

    A text may also exist in a language that is not declared; it is not offered then.
    """
    for language in languages:
        if not text.get(language, "").strip():
            yield DefinitionProblem(
                (*path, language),
                f"The text is missing in the declared language {language!r}.",
                sorted(text),
                f"a text in {language}",
                f"Add it, or take {language} out of the languages.",
            )
