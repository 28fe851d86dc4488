"""The states in which a disk may hold one file: its certain content, and every change since."""

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from tests.faults.tracing.events import Event

Rng = np.random.Generator
Choice = Callable[[list[int]], int]
"""Chooses how many of a sector's changes (given as indices since the last sync) took effect."""


@dataclass
class TracedFile:
    """One file on the disk: its certain content, and its uncertain changes, oldest first."""

    certain: bytearray = field(default_factory=bytearray)
    changes: list[Event] = field(default_factory=list)

    def sync(self, began: int) -> None:
        """Make earlier writes certain: a sync that began at `began` has returned."""
        for change in self.changes:
            if change.ended < began:
                _apply(self.certain, change)
        self.changes = [change for change in self.changes if change.ended >= began]

    def sizes(self) -> list[int]:
        """Return the sizes of the file since the last sync, the certain one first."""
        sizes = [len(self.certain)]
        for change in self.changes:
            sizes.append(_size_after(sizes[-1], change))
        return sizes

    def touched(self, sector: int) -> dict[int, list[int]]:
        """Return the sectors that may have changed, with the indices of their changes."""
        found: dict[int, list[int]] = {}
        size = len(self.certain)
        for place, change in enumerate(self.changes):
            start, end = _span(size, change)
            for number in range(start // sector, -(-end // sector)):
                found.setdefault(number, []).append(place)
            size = _size_after(size, change)
        return found

    def image(self, sector: int, choose: Choice, size: int, fill: bytes) -> bytes:
        """Return one possible content of the file, with sector versions selected by `choose`.

        The result is cut or extended to `size`; unwritten parts are filled from `fill` (at least as
        long as the greatest size).
        """
        held = bytearray(fill[: max(self.sizes())])
        held[: len(self.certain)] = self.certain
        versions = _Versions(self)
        for number, places in self.touched(sector).items():
            happened = choose(places)
            if happened:
                start = number * sector
                piece = versions.at(start, start + sector, places[:happened])
                held[start : start + len(piece)] = piece
        return bytes(held[:size]) + bytes(max(0, size - len(held)))


@dataclass(frozen=True)
class _Versions:
    """Compute single sectors of a file after some of their changes."""

    file: TracedFile

    def at(self, start: int, end: int, places: list[int]) -> bytes:
        """Return the bytes of one whole sector, padded with zeros if the file ends within it."""
        piece = bytearray(self.file.certain[start:end])
        piece += bytes(end - start - len(piece))
        for place in places:
            change = self.file.changes[place]
            if change.what == "truncate":
                cut = min(max(0, change.size - start), end - start)
                piece[cut:] = bytes(end - start - cut)
                continue
            low = max(start, change.offset)
            high = min(end, change.offset + len(change.data))
            if low < high:
                piece[low - start : high - start] = change.data[
                    low - change.offset : high - change.offset
                ]
        return bytes(piece)


def _apply(content: bytearray, change: Event) -> None:
    if change.what == "truncate":
        del content[change.size :]
        content.extend(bytes(change.size - len(content)))
        return
    content.extend(bytes(max(0, change.offset - len(content))))
    content[change.offset : change.offset + len(change.data)] = change.data


def _size_after(size: int, change: Event) -> int:
    if change.what == "truncate":
        return change.size
    return max(size, change.offset + len(change.data))


def _span(size: int, change: Event) -> tuple[int, int]:
    """Return the byte range that a change affects in a file of that size."""
    if change.what == "truncate":
        return min(size, change.size), max(size, change.size)
    # The gap between the end of the file and a later write becomes zeros.
    return min(size, change.offset), change.offset + len(change.data)
