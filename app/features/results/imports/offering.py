"""Offer an instrument of the lab's own for columns that belong to no known questionnaire.

A file from another tool often has a questionnaire that the library does not know. Its columns are
recognised by their values: whole numbers on a scale, or the same few words, in columns that the
tool did not add itself. What is offered is a draft that a person checks: key, title and the ends of
the scale are theirs to change, and the reverse-keyed items and the scoring are added to the
instrument's file. Columns that are neither used nor offered are named with how many cells they
fill, so that nothing is left out silently.
"""

import re
from collections.abc import Collection, Iterable, Sequence
from collections.abc import Mapping as Map
from dataclasses import dataclass

from app.errors import InvalidInput
from app.features.results.imports.applying import MISSING
from app.features.results.imports.proposing import (
    column_sets,
    condition_column,
    likely_instrument,
    participant_column,
)
from app.features.results.imports.scales import (
    AGREEMENT,
    ENDS,
    USUAL_HIGH,
    doubts_about,
    scales_with,
    usual_ends,
    why_not_offered,
)
from app.features.results.imports.schemas import (
    LeftOutColumn,
    Mapping,
    OfferedInstrument,
    OfferedItem,
)
from app.features.results.imports.sheet import Sheet, read_sheet
from app.protocol.editing import mapping_text
from app.science.instruments import Instrument, is_key

_OF_THE_TOOL = re.compile(
    # Qualtrics, then UXF, then what others add.
    r"startdate|enddate|recordeddate|status|ipaddress|progress|finished|distributionchannel|"
    r"userlanguage|responseid|recipient\w*|externalreference|location(latitude|longitude)|"
    r"duration\w*|experiment|ppid|session(num)?|(trial|block)num\w*|\w*(start|end)time|directory|"
    r"\w*location0|\w*filename|id|lfdn|age|alter|gender|geschlecht|timestamp|datestamp|submitdate|"
    r"lastpage|seed|startlanguage"
)
_MOST_STEPS = 101
_MOST_WORDS, _LEAST_FILLED = 11, 2
_WHOLE = re.compile(r"[+-]?\d{1,3}([.,]0+)?")
_LABEL = 300


@dataclass(frozen=True)
class _Answers:
    """What a column that looks like an item contains: whole numbers, or words of a scale."""

    column: str
    numbers: frozenset[int]
    words: frozenset[str]


@dataclass(frozen=True)
class SeenColumns:
    """A file, the instrument whose items it has, if one is known, and the columns that are read."""

    sheet: Sheet
    instrument: str | None
    used: frozenset[str]


def read_columns(text: str, known: Map[str, Instrument]) -> SeenColumns:
    """Read a file without a study and say which of its columns are read; raise InvalidInput."""
    sheet = read_sheet(text)
    likely, is_likely = likely_instrument(sheet, known)
    sets = column_sets(sheet, known[likely]) if is_likely else []
    used = {column for one in sets for column in one.items.values()}
    people = (participant_column(sheet), condition_column(sheet, used))
    named = used | {column for column in people if column is not None}
    return SeenColumns(sheet, likely if is_likely else None, frozenset(named))


def offer(
    sheet: Sheet, used: Collection[str], known: Collection[str]
) -> tuple[OfferedInstrument | None, list[LeftOutColumn]]:
    """Return the offer, if any column looks like an item, and the columns that nothing uses.

    `used`: columns that are read (`used_columns`); `known`: keys that instruments have already.
    """
    free = [name for name in sheet.header if name not in used]
    found = [one for name in free if (one := _answers_of(sheet, name)) is not None]
    found = _on_one_scale(found)
    offered = {one.column for one in found}
    left_out = [
        LeftOutColumn(name=name, filled=_filled(sheet, name), reason=_reason(sheet, name))
        for name in free
        if name not in offered
    ]
    if not found:
        return None, left_out
    numbers = set().union(*(one.numbers for one in found))
    words = set().union(*(one.words for one in found))
    scale = next(iter(scales_with(words)), ())
    low, high = usual_ends(numbers) if not words else (1, len(scale))
    items = _items(sheet, [one.column for one in found])
    seen = [f"“{one}”" for one in scale if one in words]
    return (
        OfferedInstrument(
            key=_free_key("own_scale", known),
            title="Questionnaire of our own",
            minimum=low,
            maximum=high,
            guessed_minimum=low,
            guessed_maximum=high,
            seen=_range(numbers) if numbers else ", ".join(seen),
            doubts=doubts_about(numbers, words),
            labels=list(scale),
            items=items,
        ),
        left_out,
    )


def offered_file(offered: OfferedInstrument, language: str, known: Collection[str]) -> str:
    """Return the file of an offered instrument, as a person has edited it, in YAML.

    Its provenance says which ends of the scale are still guesses (`guessed_minimum` and
    `guessed_maximum`), and a comment above the scale does too.
    Raises InvalidInput for a key that is invalid or taken, or a scale without steps.
    """
    if not is_key(offered.key) or offered.key in known:
        raise InvalidInput(
            f"{offered.key!r} cannot be the key of a new instrument",
            value=offered.key,
            valid="lower-case letters, digits and _, beginning with a letter, not used before",
            remedy="Choose a key of lower-case letters, digits and _ that no instrument has.",
        )
    if offered.minimum >= offered.maximum:
        raise InvalidInput(
            "the scale has no steps",
            value=[offered.minimum, offered.maximum],
            valid="a minimum below the maximum",
            remedy="Enter a minimum below the maximum, as the questionnaire's scale has them.",
        )
    steps = offered.maximum - offered.minimum + 1
    labels = offered.labels if len(offered.labels) == steps else []
    items = [one.key for one in offered.items]
    text = mapping_text(
        {
            "key": offered.key,
            "version": 1,
            "title": {language: offered.title},
            "languages": [language],
            "provenance": {
                "source": "Made from the columns of an imported file; the author is not recorded.",
                "licence": "Not known: ask the questionnaire's author before asking it in a study.",
                "verified": f"Not compared with a publication. {_origin_of_scale(offered)}",
                "notes": ["Add which items are reverse-keyed, and the author's scores."],
            },
            "scale": {
                "minimum": offered.minimum,
                "maximum": offered.maximum,
                "labels": [{language: one} for one in labels],
            },
            "items": [
                {
                    "key": one.key,
                    "type": "likert",
                    "required": False,
                    "text": {language: one.text},
                    "note": f"Column {one.column}",
                }
                for one in offered.items
            ],
            "scores": [
                {
                    "key": "mean_of_items" if "mean_of_items" not in items else "mean_of_all_items",
                    "label": {language: "Mean of the items as answered"},
                    "formula": f"mean({', '.join(items)})",
                    "minimum": offered.minimum,
                    "maximum": offered.maximum,
                    "note": "Not the author's scoring: no item is reversed.",
                }
            ],
        }
    )
    if not _guesses(offered):
        return text
    check = (
        f"# {_origin_of_scale(offered)}\n"
        "# Set both ends as the questionnaire has them, here and below `scores`.\n"
    )
    return text.replace("\nscale:\n", f"\n{check}scale:\n", 1)


def used_columns(mapping: Mapping | None) -> set[str]:
    """Return the columns that a mapping reads."""
    if mapping is None:
        return set()
    names = {mapping.participant, mapping.condition, mapping.date} - {None}
    return {name for name in names if name} | {
        column for one in mapping.sets for column in one.items.values()
    }


def answer_columns(sheet: Sheet, mapping: Mapping) -> list[str]:
    """Return the columns that look like items and that a mapping does not read."""
    used = used_columns(mapping)
    free = [name for name in sheet.header if name not in used]
    found = [one for name in free if (one := _answers_of(sheet, name)) is not None]
    return [one.column for one in _on_one_scale(found)]


def _answers_of(sheet: Sheet, name: str) -> _Answers | None:
    values = [value for value in sheet.values(name) if value.casefold() not in MISSING]
    if _is_of_the_tool(name) or len(values) < _LEAST_FILLED:
        return None
    numbers = _whole_numbers(values)
    if numbers is not None:
        own = max(numbers) - min(numbers) < _MOST_STEPS
        # Numbers that count the rows are no answers.
        counted = len(numbers) == len(values) > _MOST_WORDS
        return _Answers(name, numbers, frozenset()) if own and not counted else None
    words = frozenset(value.casefold() for value in values)
    return _Answers(name, frozenset(), words) if scales_with(words) else None


def _on_one_scale(found: Sequence[_Answers]) -> list[_Answers]:
    """Return the largest group of columns that can be on one scale: words, or similar numbers."""
    in_words = max(
        ([one for one in found if one.words and one.words <= set(scale)] for scale in AGREEMENT),
        key=len,
    )
    groups = {
        (low, high): [
            one
            for one in found
            if one.numbers and low <= min(one.numbers) and max(one.numbers) <= high
        ]
        for low, ends in ENDS.items()
        for high in ends
    }
    usual = [group for (_, high), group in groups.items() if high <= USUAL_HIGH]
    usual += [in_words, [one for one in found if one.numbers and min(one.numbers) < 0]]
    best = max(usual, key=len)  # the first, so the narrowest, of equally large groups
    # An age would fit a scale of 0 to 100, too: such a scale has to have most of the columns.
    widest = max(groups.values(), key=len)
    return widest if len(widest) > max(2 * len(best), 2) else best


def _whole_numbers(values: Sequence[str]) -> frozenset[int] | None:
    """Return the numbers of cells that are all whole numbers of up to three digits, else None."""
    if not all(_WHOLE.fullmatch(value) for value in values):
        return None
    return frozenset(int(re.split("[.,]", value)[0]) for value in values)


def _range(numbers: Collection[int]) -> str:
    least, most = min(numbers), max(numbers)
    return f"only {least}" if least == most else f"{least} to {most}"


def _reason(sheet: Sheet, name: str) -> str | None:
    """Return why a column that could be an item is not offered; None for all other columns."""
    values = [value for value in sheet.values(name) if value.casefold() not in MISSING]
    if _is_of_the_tool(name) or len(values) < _LEAST_FILLED:
        return None
    return why_not_offered(values, _whole_numbers(values))


def _is_of_the_tool(name: str) -> bool:
    bare = "".join(letter for letter in name.casefold() if letter.isalnum())
    return _OF_THE_TOOL.fullmatch(bare) is not None


def _guesses(offered: OfferedInstrument) -> list[int]:
    """Return the ends of the scale that are still those that were guessed."""
    ends = (
        (offered.minimum, offered.guessed_minimum),
        (offered.maximum, offered.guessed_maximum),
    )
    return [own for own, guessed in ends if own == guessed]


def _origin_of_scale(offered: OfferedInstrument) -> str:
    """Return where the ends of the scale come from: a person, or the answers in the file."""
    scale = f"Scale {offered.minimum} to {offered.maximum}"
    guesses = _guesses(offered)
    if not guesses:
        return f"{scale}, set by a person."
    from_answers = f"guessed from the answers seen ({offered.seen}); nobody has confirmed it."
    if len(guesses) == 2:
        return f"{scale}, {from_answers}"
    end = "its minimum" if guesses[0] == offered.minimum else "its maximum"
    return f"{scale}: {end} {from_answers}"


def _items(sheet: Sheet, columns: Sequence[str]) -> list[OfferedItem]:
    taken: set[str] = {"x", "mean", "sum", "min", "max", "abs", "sqrt"}
    items = []
    for column in columns:
        key = _free_key(_key_of(column), taken)
        taken.add(key)
        label = sheet.labels[sheet.column(column)][:_LABEL]
        items.append(OfferedItem(key=key, column=column, text=label or column))
    return items


def _key_of(column: str) -> str:
    bare = re.sub(r"[^a-z0-9]+", "_", column.casefold()).strip("_")[:36]
    return bare if re.match(r"[a-z]", bare) else f"q_{bare}".rstrip("_")


def _free_key(key: str, taken: Iterable[str]) -> str:
    used, number = set(taken), 2
    free = key
    while free in used:
        free, number = f"{key}_{number}", number + 1
    return free


def _filled(sheet: Sheet, name: str) -> int:
    return sum(value.casefold() not in MISSING for value in sheet.values(name))
