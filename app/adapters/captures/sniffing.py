"""Examine the beginning of a file, by which formats recognise their files.

Extensions are not enough: half of the formats use .csv.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

from app.adapters.captures.text import first_lines

# Other files that labs have, recognised so that the error message can name them.
_KNOWN_ELSEWHERE: tuple[tuple[bytes, str], ...] = (
    (b"\n\r\r\n", "a pcapng recording of network packets"),
    (b"XDF:", "an XDF recording of LabStreamingLayer"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"Kaydara FBX", "an FBX scene"),
    (b"glTF", "a glTF scene"),
    (b"\x89HDF", "an HDF5 file"),
    (b"MATLAB", "a MATLAB file"),
    (b"%PDF", "a PDF"),
)


@dataclass(frozen=True)
class Head:
    """The beginning of a file, as needed to recognise its format.

    Attributes:
        data: the whole file.
        lines: the first 60, stripped.
    """

    data: bytes
    lines: tuple[str, ...]

    @classmethod
    def of(cls, data: bytes) -> Self:
        """Return the head of a file."""
        return cls(data, tuple(line.strip() for line in first_lines(data, 60)))

    @property
    def first(self) -> str:
        """The first line that is not blank; empty if there is none."""
        return next((line for line in self.lines if line), "")

    @property
    def word(self) -> str:
        """The first word of the file, in lower case."""
        return self.first.split(maxsplit=1)[0].lower() if self.first else ""

    def first_without(self, comment: str) -> str:
        """Return the first line that is neither blank nor begins with `comment`."""
        return next((line for line in self.lines if line and not line.startswith(comment)), "")

    def cells(self, separator: str = ",") -> list[str]:
        """Return the first line as cells of a table, without quotes and in lower case."""
        return [cell.strip().strip('"').lower() for cell in self.first.split(separator)]

    def has_columns(self, fits: Callable[[list[str]], bool]) -> bool:
        """Return whether the first line fits as a table's column titles, with any separator."""
        return any(fits(self.cells(separator)) for separator in (",", ";", "\t"))


def describe_unknown_file(data: bytes) -> str:
    """Describe a file of unknown format to the user who chose it."""
    if not data.strip():
        return "the file is empty"
    for start, title in _KNOWN_ELSEWHERE:
        if data.startswith(start):
            return f"the file is {title}"
    sample = data[:4096]
    if b"\x00" in sample or sum(byte < 9 for byte in sample) > len(sample) // 50:
        return f"the file is binary and begins with the bytes {sample[:8].hex(' ')}"
    first = next((line.strip() for line in first_lines(data, 60) if line.strip()), "")
    if first.startswith(("{", "[")):
        return f"the file looks like JSON and begins with {first[:60]!r}"
    return f"the file is a text that begins with {first[:80]!r}"
