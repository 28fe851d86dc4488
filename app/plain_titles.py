"""Titles and codes that people read: no control characters, and none that turn writing around.

A title with U+202E shows the rest of a line backwards, so that two things look alike that are not.
Titles in scripts that are written from right to left need none of these characters: their letters
have a direction of their own.
"""

import re
from typing import Annotated, Final

from pydantic import AfterValidator, StringConstraints

_TURNING = "\u061c\u200e\u200f\u202a-\u202e\u2066-\u2069"
_NOT_PLAIN = re.compile(f"[\x00-\x1f\x7f-\x9f\u2028\u2029{_TURNING}]")
# Without joiners (U+200C, U+200D), which scripts and emoji need.
_HIDDEN = "\u00ad\u180e\u200b\u2060-\u2064\ufeff"
_NOT_PLAIN_IN_LINES = re.compile(
    f"[\x00-\x08\x0b\x0c\x0e-\x1f\x7f-\x9f\u2028\u2029{_TURNING}{_HIDDEN}]"
)


def not_plain(text: str) -> str | None:
    """Return which character a title must not have and where, as a sentence; None if it is plain.

    Positions count from 1.
    """
    return _told(_NOT_PLAIN.search(text))


def plain(text: str) -> str:
    """Return a plain text as it is; raise ValueError for any other (`not_plain`)."""
    if (problem := not_plain(text)) is not None:
        raise ValueError(problem)
    return text


def plain_lines(text: str) -> str:
    """Return a text of several lines as it is; raise ValueError if it is not plain.

    It may have tabs and line breaks, and no invisible character. Stored titles may have such
    characters from earlier releases, so these are refused in new notes only.
    """
    if (problem := _told(_NOT_PLAIN_IN_LINES.search(text))) is not None:
        raise ValueError(problem)
    return text


def _told(found: re.Match[str] | None) -> str | None:
    if found is None:
        return None
    kind = "is a control character"
    if re.fullmatch(f"[{_TURNING}]", found[0]):
        kind = "turns the direction of writing"
    elif re.fullmatch(f"[{_HIDDEN}]", found[0]):
        kind = "is invisible"
    return f"Character {found.start() + 1} is U+{ord(found[0]):04X}, which {kind}: remove it."


def made_plain(text: str) -> str:
    """Return a text without the characters that a title must not have.

    For a name that comes with something which must not be refused because of it.
    """
    return _NOT_PLAIN.sub("", text).strip()


NO_NAMES: Final = frozenset(
    {"null", "none", "nan", "na", "true", "false", "yes", "no", "on", "off"}
)
"""Words that YAML, pandas or R read as nothing, or as yes or no."""

LONGEST_TITLE: Final = 200
"""In characters."""

PlainTitle = Annotated[
    str,
    StringConstraints(strip_whitespace=True, min_length=1, max_length=LONGEST_TITLE),
    AfterValidator(plain),
]
"""A title of up to 200 characters, of which none is a control character or turns writing around."""
