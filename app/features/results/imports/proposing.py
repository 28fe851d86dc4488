"""Propose what the columns of a file mean; a person checks and corrects the proposal."""

import re
from collections.abc import Iterable, Sequence
from collections.abc import Mapping as Map

from app.features.results.imports.schemas import ColumnSet, Mapping
from app.features.results.imports.sheet import Sheet
from app.protocol import StudyProtocol
from app.science.instruments import Instrument

_PARTICIPANT = ("ppid", "participant", "participantcode", "participantid", "pid", "subject")
_MORE_PARTICIPANT = ("subjectid", "code", "proband", "versuchsperson", "vp", "responseid", "id")
_CONDITION = ("condition", "bedingung", "latency", "latencyms", "method", "response", "cond")
_DATE = ("recordeddate", "date", "datum", "enddate", "submitdate", "startdate")


LEAST_SHARE = 1 / 3
"""The share of an instrument's items that need a column before a file counts as answers to it.

Items are often called q1, q2, ...: a file with a Q2 of its own has answers to something else.
"""


def likely_instrument(sheet: Sheet, instruments: Map[str, Instrument]) -> tuple[str, bool]:
    """Return the instrument with the largest share of items that have a column, and if it is large.

    If no item has a column, the first instrument by name is returned.
    """

    def share(key: str) -> float:
        sets = column_sets(sheet, instruments[key])
        return max((len(one.items) for one in sets), default=0) / len(instruments[key].items)

    best = max(sorted(instruments), key=share)
    return best, share(best) >= LEAST_SHARE


def propose(sheet: Sheet, instrument: Instrument, protocol: StudyProtocol) -> Mapping | None:
    """Return a mapping, or None if no item column or no participant column was identified."""
    sets = column_sets(sheet, instrument)
    participant = participant_column(sheet)
    if not sets or participant is None:
        return None
    taken = {participant, *(column for one in sets for column in one.items.values())}
    condition = None if len(sets) > 1 else condition_column(sheet, taken)
    words = (
        sorted(set(sheet.values(condition)) - {""})
        if condition is not None
        else [one.condition for one in sets if one.condition is not None]
    )
    return Mapping(
        instrument=instrument.key,
        participant=participant,
        condition=condition,
        date=_named(sheet, _DATE, taken),
        sets=sets,
        conditions=study_conditions(words[:100], protocol),
        header_rows=sheet.header_rows,
    )


def participant_column(sheet: Sheet) -> str | None:
    """Return the column that names the participants; None if there is no usual one."""
    return _named(sheet, (*_PARTICIPANT, *_MORE_PARTICIPANT))


def condition_column(sheet: Sheet, taken: Iterable[str] = ()) -> str | None:
    """Return the column that names the conditions and is not taken; None if there is none."""
    return _named(sheet, _CONDITION, taken)


def column_sets(sheet: Sheet, instrument: Instrument) -> list[ColumnSet]:
    """Return the columns of the items: one set for a tidy file, several for a wide one."""
    plain: dict[str, str] = {}
    marked: dict[str, dict[str, str]] = {}
    texts = {
        _bare(text): item.key for item in instrument.items for text in dict(item.text).values()
    }
    keys = {_bare(item.key): item.key for item in instrument.items}
    if len(keys) == 1:
        # The only item of an instrument is often named after the instrument.
        keys[_bare(instrument.key)] = instrument.items[0].key
    for name, label in zip(sheet.header, sheet.labels, strict=True):
        own = _bare(name).removeprefix(_bare(instrument.key))
        item = keys.get(_bare(name)) or keys.get(own) or texts.get(_bare(label))
        if item is not None:
            plain.setdefault(item, name)
            continue
        for word, rest in _split(name):
            if word in keys:
                marked.setdefault(rest, {}).setdefault(keys[word], name)
    best = max((len(items) for items in marked.values()), default=0)
    wide = [
        ColumnSet(items=items, condition=rest[:80])
        for rest, items in marked.items()
        if len(items) == best
    ]
    if len(plain) >= best:
        return [ColumnSet(items=plain)] if plain else []
    return wide[:24]


def study_conditions(words: Iterable[str], protocol: StudyProtocol) -> dict[str, str]:
    """Map words of a file to the study's conditions by their key, label or latency."""
    found: dict[str, str] = {}
    for word in words:
        for one in protocol.conditions:
            number = re.fullmatch(r"(\d+(?:\.\d+)?)\s*(?:ms)?", word.strip().lower())
            labels = {_bare(text) for text in dict(one.label).values()}
            same = number is not None and float(number[1]) == one.latency_ms
            latency = same and protocol.has_latencies_apart
            if latency or _bare(word) in {_bare(one.key), *labels}:
                found[word] = one.key
                break
    return found


def _split(name: str) -> Iterable[tuple[str, str]]:
    """Yield ("q1", "125 ms") and the reverse for "Q1_125 ms"."""
    for at, letter in enumerate(name):
        if letter in "_.- :/" and 0 < at < len(name) - 1:
            left, right = name[:at].strip(), name[at + 1 :].strip()
            yield _bare(left), right
            yield _bare(right), left


def _named(sheet: Sheet, names: Sequence[str], taken: Iterable[str] = ()) -> str | None:
    free = {_bare(column): column for column in sheet.header if column not in set(taken)}
    return next((free[name] for name in names if name in free), None)


def _bare(text: str) -> str:
    return "".join(letter for letter in text.casefold() if letter.isalnum())
