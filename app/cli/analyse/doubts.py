"""Doubt what looks like a slip in a table for `reembody analyse`: levels, orders, codes, decimals.

Nothing is corrected, since only the person who wrote the table knows: each doubt is a sentence with
the line, what was done, and what to do.
"""

import re
from collections.abc import Collection, Sequence
from difflib import get_close_matches
from statistics import median

from app.cli.analyse.inputs import TidyInput, plainly
from app.science.instruments import USUAL_MISSING_CODES
from app.science.statistics import Cells, as_number, has_order, ordered_levels, place_of

_FOR_REMARKS = re.compile(
    r"|notes?|remarks?|comments?|bemerkung(en)?|anmerkung(en)?|kommentare?|notiz(en)?|unnamed"
    r"|columns?|spalten?|x"
)
"""Names of columns in which nobody expects numbers of one or two digits."""
_SHOWN = 8
_RARE, _USUAL = 0.1, 0.5
"""Share of the subjects who have a level at most, and other levels at least, for it to be doubted.

One subject is always few."""
_FEWEST_SUBJECTS = 3


def split_decimals(measure: str, read: TidyInput) -> list[str]:
    """Ask whether decimal commas have moved the decimals of the measure into the next column.

    In a table with commas, 4,36 is two cells, and fits a header with a column for remarks.
    """
    if read.right_of_measure is None:
        return []
    name, cells = read.right_of_measure
    filled = [
        (value, cell, line)
        for value, cell, line in zip(read.measure, cells, read.lines, strict=True)
        if cell
    ]
    plain = _FOR_REMARKS.fullmatch(re.sub(r"[\W\d_]+", "", name.casefold())) is not None
    if not plain or 2 * len(filled) < len(cells):
        return []
    if not all(re.fullmatch(r"\d{1,2}", cell) for _, cell, _ in filled) or not all(
        re.fullmatch(r"[+-]?\d+", value) for value in read.measure if value
    ):
        return []
    value, cell, line = filled[0]
    asked = (
        f"line {line} has {value} in {measure} and {cell} in {name!r} beside it, and so on: is it"
        f" {value},{cell}, whose decimal comma separates columns here? {measure} was read as"
        " whole numbers; if it has decimals, save the file with semicolons or decimal points"
    )
    return [asked]


def contradicted_orders(cells: Cells, declared: Collection[str]) -> list[str]:
    """Note declared orders of numeric levels that are not the order of the numbers."""
    found = []
    for factor, levels in zip(cells.factors, cells.levels, strict=True):
        usual = ordered_levels(levels)
        if factor in declared and has_order(levels) and levels != usual:
            found.append(
                f"{factor}: the declared order {', '.join(levels)} is not that of the numbers"
                f" ({', '.join(usual)}); trends and the first level that differs follow the"
                " declared one. Leave --order away to have the numbers in order"
            )
    return found


def unused_codes(measure: str, read: TidyInput) -> list[str]:
    """Note codes of missing values that occur in no cell, which may be mistyped."""
    return [
        f"--missing {code} stands in no cell of {measure} that was read: was another code meant?"
        for code in read.unused_codes
    ]


def mistyped_levels(factor: str, read: TidyInput) -> list[str]:
    """Ask about levels that hardly anybody has, or that are spelt almost as another one.

    One row with 1255 instead of 125 makes a level of its own, which all other subjects lack.
    """
    column = read.within[factor]
    levels = ordered_levels(column)
    places = {text: place_of(levels, text) for text in set(column)}
    having: list[dict[str, int]] = [{} for _ in levels]
    """For each level, the subjects who have it, and the line where each first has."""
    for subject, text, line in zip(read.subjects, column, read.lines, strict=True):
        having[places[text]].setdefault(subject, line)
    rare = _rare(factor, levels, having)
    # A rare level is asked about with its line, and not once more for its spelling.
    return list(rare.values()) + _spelt_alike(factor, levels, already=set(rare))


def _rare(factor: str, levels: Sequence[str], having: Sequence[dict[str, int]]) -> dict[str, str]:
    """Return a question about each level that hardly anybody has, by level."""
    people = len({subject for own in having for subject in own})
    usual = median(len(own) for own in having)
    if people < _FEWEST_SUBJECTS or usual < _USUAL * people:
        return {}
    found = {}
    for level, own in zip(levels, having, strict=True):
        if len(own) > max(1.0, _RARE * people):
            continue
        lines = ", ".join(f"{line} ({who})" for who, line in list(own.items())[:_SHOWN])
        others = [one for one in levels if one != level]
        alike = [one for one in others if plainly(one) == plainly(level)]
        close = alike or get_close_matches(level, others, n=1)
        found[level] = (
            f"{factor} {level!r} is only in line {lines}, the others ({', '.join(others)}) are of"
            f" most subjects: {f'was {close[0]!r} meant' if close else 'was it mistyped'}? It was"
            " taken as a level of its own; if it is not one, correct the file"
        )
    return found


def _spelt_alike(factor: str, levels: Sequence[str], already: Collection[str] = ()) -> list[str]:
    spelt: dict[str, list[str]] = {}
    for level in levels:
        spelt.setdefault(plainly(level), []).append(level)
    return [
        f"{factor} {' and '.join(map(repr, names))} differ only in capitals, spaces or dashes: one"
        f" level? They were analysed as {len(names)}; if they are one, spell them alike"
        for names in spelt.values()
        if len(names) > 1
        and any(as_number(name) is None for name in names)
        and not set(already).intersection(names)
    ]


def nearly_asked_for(read: TidyInput) -> list[str]:
    """Ask about rows that a condition left out for a slip in the spelling of their value."""
    found = []
    for condition, value, lines in read.spelt_otherwise:
        shown = ", ".join(map(str, lines[:_SHOWN]))
        more = f" and {len(lines) - _SHOWN} more" if len(lines) > _SHOWN else ""
        found.append(
            f"--where {condition!r} left out line {shown}{more} with {value!r}, which differs only"
            " in capitals, spaces or dashes: the same? If so, spell them alike"
        )
    return found


def doubtful_means(read: TidyInput) -> list[str]:
    """Ask about words that are averaged over and spelt alike, and name who lacks some of them.

    The mean of a cell without the feet is one of the hands alone, and differs for that reason.
    """
    found = []
    keys = list(zip(read.subjects, *read.within.values(), strict=True))
    for name, words in read.averaged_words.items():
        found += _spelt_alike(name, ordered_levels(words))
        having: dict[tuple[str, ...], set[str]] = {}
        for key, word in zip(keys, words, strict=True):
            having.setdefault(key, set()).add(plainly(word))
        every = {plainly(word) for word in words}
        lacking = sorted({key[0] for key, own in having.items() if own != every})
        if lacking:
            shown = ", ".join(lacking[:_SHOWN]) + (", ..." if lacking[_SHOWN:] else "")
            found.append(
                f"{shown} lack a value of {name} in some cell"
                f" ({', '.join(ordered_levels(words))}): its mean is one of the others alone."
                f" Name the factor with --within {name!r} to leave them out"
            )
    return found


def missing_codes(measure: str, read: TidyInput) -> list[str]:
    """Name values such as -99 that are usual codes for a missing value and unlike all others.

    They are unlike if they are farther away than all others are apart, or the only negative ones.
    """
    numbers = [as_number(text) for text in read.measure]
    others = [one for one in numbers if one is not None and one not in USUAL_MISSING_CODES]
    if not others:
        return []
    low, high = min(others), max(others)
    # Where 0 to 6 are answers, -1 may be one: some scales have a middle of 0.
    from_zero = low == 0.0 and all(map(float.is_integer, others))
    found = []
    for code in sorted(USUAL_MISSING_CODES & {one for one in numbers if one is not None}):
        far = max(low - code, code - high) > high - low
        alone = code < 0.0 <= low and not (code == -1.0 and from_zero)
        if not (far or alone):
            continue
        lines = [line for line, one in zip(read.lines, numbers, strict=True) if one == code]
        shown = ", ".join(str(line) for line in lines[:_SHOWN])
        more = f" and {len(lines) - _SHOWN} more" if len(lines) > _SHOWN else ""
        found.append(
            f"{measure} is {code:g} in line {shown}{more},"
            f" {'far from all other values' if far else 'negative beside all other values'}"
            f" ({low:g} to {high:g}); it was used as a number. If it stands for a missing value,"
            f" say so with --missing {code:g}"
        )
    return found
