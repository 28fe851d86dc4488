"""Compare two trees of plain values, place by place.

Lists are aligned before they are compared: a step inserted at the front is one added step, not a
change of every step after it.
"""

import difflib
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Literal

from app.protocol.common import canonical_json
from app.protocol.source import Path, Plain


@dataclass(frozen=True)
class Difference:
    """One place at which two trees differ; its path is the older tree's if it existed there."""

    path: Path
    kind: Literal["added", "removed", "changed"]
    before: Plain
    after: Plain


def differences(before: Plain, after: Plain, path: Path = ()) -> Iterator[Difference]:
    """Yield every difference, in the order of the older tree."""
    if isinstance(before, dict) and isinstance(after, dict):
        for key in [*before, *(key for key in after if key not in before)]:
            inner = (*path, key)
            if key not in after:
                yield Difference(inner, "removed", before[key], None)
            elif key not in before:
                yield Difference(inner, "added", None, after[key])
            else:
                yield from differences(before[key], after[key], inner)
    elif isinstance(before, list) and isinstance(after, list):
        yield from _lists(before, after, path)
    elif canonical_json(before) != canonical_json(after):
        yield Difference(path, "changed", before, after)


def _lists(before: list[Plain], after: list[Plain], path: Path) -> Iterator[Difference]:
    names = [_name(one) for one in before], [_name(one) for one in after]
    matcher = difflib.SequenceMatcher(None, *names, autojunk=False)
    for tag, old, old_end, new, new_end in matcher.get_opcodes():
        if tag == "equal" or (tag == "replace" and old_end - old == new_end - new):
            for at, other in zip(range(old, old_end), range(new, new_end), strict=True):
                yield from differences(before[at], after[other], (*path, at))
            continue
        for at in range(old, old_end):
            yield Difference((*path, at), "removed", before[at], None)
        for other in range(new, new_end):
            yield Difference((*path, other), "added", None, after[other])


def _name(value: Plain) -> str:
    """Return the text that identifies a list entry, even after other parts of it have changed."""
    if isinstance(value, dict):
        for key in ("key", "number", "limb"):
            if key in value:
                return f"{key} {value[key]}"
        if "step" in value:
            return canonical_json([value.get(key) for key in ("step", "instrument", "text")])
    return canonical_json(value)
