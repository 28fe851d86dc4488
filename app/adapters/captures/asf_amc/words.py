"""Split the text of both Acclaim files into lines of words."""

import math
from collections.abc import Iterator
from dataclasses import dataclass

from app.adapters.captures.capture import CaptureError
from app.adapters.captures.text import text_lines

_LARGEST = 1e9


@dataclass(frozen=True)
class Line:
    """A line that is neither empty nor a comment."""

    number: int
    words: list[str]


class Lines:
    """Reads the lines of a text; the line that ends a section is returned again afterwards."""

    def __init__(self, data: bytes) -> None:
        self._lines = (
            Line(number, words)
            for number, text in enumerate(text_lines(data), 1)
            if (words := text.split()) and not words[0].startswith("#")
        )
        self._pushed_back: Line | None = None

    def next(self) -> Line | None:
        """Return the next line, or None at the end."""
        line, self._pushed_back = self._pushed_back or next(self._lines, None), None
        return line

    def section(self) -> Iterator[Line]:
        """Yield the lines before the next one that begins with a colon."""
        while (line := self.next()) is not None:
            if line.words[0].startswith(":"):
                self._pushed_back = line
                return
            yield line


def number(line: Line, place: int, expected: str) -> float:
    """Parse the word at a position as a finite number of plausible size."""
    word = line.words[place] if len(line.words) > place else ""
    try:
        value = float(word)
    except ValueError:
        raise CaptureError(f"expected {expected}, got {word[:40]!r}.", line=line.number) from None
    if not math.isfinite(value) or abs(value) > _LARGEST:
        raise CaptureError(f"{expected} is {word[:40]}: that is out of range.", line=line.number)
    return value


def numbers(line: Line, first: int, count: int) -> list[float]:
    """Parse `count` numbers from the position `first`."""
    return [number(line, place, "a number") for place in range(first, first + count)]
