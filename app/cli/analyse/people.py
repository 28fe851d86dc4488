"""Doubt whether the subjects of a table are people, each of them once.

Nothing is corrected, since only the person who wrote the table knows: each doubt is a sentence with
the names, what was done, and what to do.
"""

import re
from collections.abc import Sequence
from itertools import pairwise
from unicodedata import normalize

from app.cli.analyse.inputs import TidyInput
from app.science.statistics import Cells, as_number

_SUMMARIES = frozenset(
    {"mean", "means", "average", "avg", "median", "sd", "std", "stdev", "stddev", "se", "sem"}
    | {"sum", "total", "totals", "subtotal", "count", "variance", "minimum", "maximum"}
    | {"mittelwert", "mittel", "durchschnitt", "schnitt", "summe", "gesamt", "gesamtsumme"}
    | {"standardabweichung", "stabw", "stdabw", "anzahl", "varianz", "ergebnis", "moyenne"}
    | {"somme", "media", "promedio", "suma"}
)
"""Words with which spreadsheets name a row of means, sums or the like."""
_SHOWN = 8
_TWO = 2
_CHANCE = 0.01
"""Pairs of people with the same values who are expected by chance, at most, for a doubt."""


def alike_subjects(read: TidyInput, column: str) -> list[str]:
    """Ask about subjects whose names differ only in what a slip changes, and may be one person.

    That is capitals, spaces, dashes, leading zeros (1, 01 and 1.0 are one number), and how letters
    such as u with two dots are encoded in Unicode, which cannot be seen.
    """
    first: dict[str, int] = {}
    for name, line in zip(read.subjects, read.lines, strict=True):
        first.setdefault(name, line)
    spelt: dict[object, list[str]] = {}
    for name in first:
        spelt.setdefault(_as_person(name), []).append(name)
    alike: dict[str, list[list[str]]] = {}
    for names in spelt.values():
        if len(names) > 1:
            alike.setdefault(_difference(names), []).append(names)
    return [
        f"{column} {_listed([' and '.join(names) for names in groups])} differ only in"
        f" {difference}: one person{' each' if len(groups) > 1 else ''}? They begin in line"
        f" {_listed([' and '.join(str(first[one]) for one in names) for names in groups])}, and"
        f" each was analysed as {max(map(len, groups))}; if they are one, spell them alike"
        for difference, groups in alike.items()
    ]


def _listed(texts: Sequence[str]) -> str:
    more = f"; and {len(texts) - _SHOWN} more" if texts[_SHOWN:] else ""
    return "; ".join(texts[:_SHOWN]) + more


def _as_person(name: str) -> object:
    """Return what is left of a name without what a slip changes; a number for a number."""
    plain = normalize("NFKC", name).casefold()
    number = as_number(plain)
    if number is not None:
        return number
    # A dash between two digits says more: 1-2 is not 12.
    joined = re.sub(r"(?<=\d)[\s_-]+(?=\d)", "-", plain.strip())
    joined = re.sub(r"(?<!\d)[\s_-]+|[\s_-]+(?!\d)", "", joined)
    return re.sub(r"(?<!\d)0+(?=\d)", "", joined)


def _difference(names: Sequence[str]) -> str:
    """Say what names differ in, if it is one thing only."""
    for words, plain in (
        ("capitals", str.casefold),
        ("how their letters are encoded (Unicode), which cannot be seen", _composed),
    ):
        if len({plain(name) for name in names}) == 1:
            return words
    if all(as_number(name) is not None for name in names):
        return "how one number is written"
    return "capitals, spaces, dashes or leading zeros"


def _composed(name: str) -> str:
    return normalize("NFKC", name)


def summary_rows(read: TidyInput, column: str) -> list[str]:
    """Ask about subjects whose name is that of a spreadsheet's row of means, sums or the like."""
    lines: dict[str, list[int]] = {}
    for name, line in zip(read.subjects, read.lines, strict=True):
        # SD 12 may be the initials of a person; SD (n-1) is none.
        plain = re.sub(r"\(.*?\)", "", name.casefold())
        word = re.split(r"[^\w]+", plain)[0]
        if word in _SUMMARIES and not any(map(str.isdigit, plain)):
            lines.setdefault(name, []).append(line)
    return [
        f"{column} {name!r} in line {', '.join(map(str, own[:_SHOWN]))}"
        f"{' ...' if own[_SHOWN:] else ''} looks like a row of a summary: is it a person? It was"
        " analysed as one; if it is none, remove these rows"
        for name, own in lines.items()
    ]


def same_people(cells: Cells, column: str) -> list[str]:
    """Ask about subjects with the same values in all cells, where that is hardly chance.

    Coarse answers coincide: with K steps between the smallest and the largest value, two people
    share one by chance at most about 3 times in K, since most answers are near the middle. People
    are asked about if fewer than one pair in a hundred such tables would be alike.
    """
    complete = cells.complete()
    if len(complete.subjects) < _TWO:
        return []
    rows = complete.values.reshape(len(complete.subjects), -1)
    named: dict[tuple[float, ...], list[str]] = {}
    for name, row in zip(complete.subjects, rows.tolist(), strict=True):
        if min(row) < max(row):
            named.setdefault(tuple(row), []).append(name)
    alike = [names for names in named.values() if len(names) > 1]
    if not alike:
        return []
    different = sorted(set(rows.ravel().tolist()))
    finest = min(after - before for before, after in pairwise(different))
    steps = 1.0 + (different[-1] - different[0]) / finest
    pairs = len(rows) * (len(rows) - 1) / 2.0
    if pairs * min(1.0, 3.0 / steps) ** rows.shape[1] >= _CHANCE:
        return []
    shown = _listed([" and ".join(names[:_SHOWN]) for names in alike])
    asked = (
        f"{column} {shown} have exactly the same values in all cells: were rows copied? They were"
        " analysed as different people; if they are one, remove the copy"
    )
    return [asked]
