"""Parse the HIERARCHY section of BVH: nested joints, each with an offset and channels."""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field

from app.adapters.bvh.clip import BvhError, BvhLimits

_AXES = ("X", "Y", "Z")
CHANNEL_NAMES = tuple(f"{axis}{kind}" for kind in ("position", "rotation") for axis in _AXES)
_CANONICAL = {name.lower(): name for name in CHANNEL_NAMES}


@dataclass
class Hierarchy:
    """The joints parsed so far; lengths in the file's units."""

    names: list[str] = field(default_factory=list)
    parents: list[int] = field(default_factory=list)
    offsets: list[tuple[float, float, float]] = field(default_factory=list)
    channels: list[tuple[str, ...]] = field(default_factory=list)
    end_sites: list[tuple[int, tuple[float, float, float]]] = field(default_factory=list)


class _Words:
    """The words of a text, with the line number of each."""

    def __init__(self, lines: Iterator[tuple[int, str]]) -> None:
        self._words: Iterator[tuple[str, int]] = (
            (word, number) for number, line in lines for word in line.split()
        )
        self.line = 0
        self._pushed_back: str | None = None

    def next(self, expected: str) -> str:
        """Return the next word.

        At the end of the text, raise BvhError with a description of what is `expected`.
        """
        if self._pushed_back is not None:
            word, self._pushed_back = self._pushed_back, None
            return word
        found = next(self._words, None)
        if found is None:
            raise BvhError(self.line, f"the text ends where {expected} is expected.")
        word, self.line = found
        return word

    def give_back(self, word: str) -> None:
        self._pushed_back = word

    def expect(self, literal: str) -> None:
        word = self.next(repr(literal))
        if word.upper() != literal:
            raise BvhError(self.line, f"expected {literal!r}, got {word!r}.")

    def number(self, expected: str) -> float:
        word = self.next(expected)
        return read_number(word, self.line, expected)

    def name(self) -> tuple[str, int]:
        """Return the words before the opening brace, as one name, and their line.

        Names may contain spaces.
        """
        words, line = [], self.line
        while (word := self.next("a joint name and '{'")) != "{":
            words.append(word)
            line = self.line
        self.give_back("{")
        return " ".join(words), line


def read_number(word: str, line: int, expected: str) -> float:
    """Parse a finite number, or raise BvhError."""
    try:
        value = float(word)
    except ValueError:
        raise BvhError(line, f"expected {expected}, got {word!r}.") from None
    if not math.isfinite(value):
        raise BvhError(line, f"{expected} is {word}, only finite numbers are valid.")
    return value


def read_hierarchy(lines: Iterator[tuple[int, str]], limits: BvhLimits) -> Hierarchy:
    """Parse numbered lines up to and including the one with the word MOTION.

    Raises:
        BvhError: the grammar or a limit is violated; the error names the line.
    """
    words, tree = _Words(lines), Hierarchy()
    words.expect("HIERARCHY")
    words.expect("ROOT")
    _read_joint(words, tree, [], limits)
    word = words.next("'MOTION'")
    if word.upper() == "ROOT":
        raise BvhError(words.line, "a second ROOT: one skeleton per file can be read, split it.")
    if word.upper() != "MOTION":
        raise BvhError(words.line, f"expected 'MOTION', got {word!r}.")
    return tree


def _read_joint(words: _Words, tree: Hierarchy, above: list[int], limits: BvhLimits) -> None:
    """Parse joints without recursion, so that deep nesting cannot exhaust the stack."""
    open_joints = list(above)
    _open_joint(words, tree, open_joints, limits)
    while open_joints:
        word = words.next("'JOINT', 'End Site' or '}'")
        match word.upper():
            case "}":
                open_joints.pop()
            case "JOINT":
                _open_joint(words, tree, open_joints, limits)
            case "END":
                words.expect("SITE")
                words.expect("{")
                words.expect("OFFSET")
                tree.end_sites.append((open_joints[-1], _read_offset(words)))
                words.expect("}")
            case _:
                raise BvhError(words.line, f"expected JOINT, End Site or '}}', got {word!r}.")


def _open_joint(words: _Words, tree: Hierarchy, open_joints: list[int], limits: BvhLimits) -> None:
    name, line = words.name()
    if not name or name in tree.names:
        problem = "a joint has no name" if not name else f"a second joint is called {name!r}"
        raise BvhError(line, f"{problem}: every joint needs a name of its own.")
    if len(open_joints) >= limits.depth:
        raise BvhError(words.line, f"joints are nested deeper than {limits.depth}.")
    if len(tree.names) >= limits.joints:
        raise BvhError(words.line, f"more than {limits.joints} joints.")
    words.expect("{")
    words.expect("OFFSET")
    tree.offsets.append(_read_offset(words))
    words.expect("CHANNELS")
    tree.channels.append(_read_channels(words))
    tree.parents.append(open_joints[-1] if open_joints else -1)
    open_joints.append(len(tree.names))
    tree.names.append(name)


def _read_offset(words: _Words) -> tuple[float, float, float]:
    x, y, z = (words.number(f"the {axis} offset") for axis in _AXES)
    return (x, y, z)


def _read_channels(words: _Words) -> tuple[str, ...]:
    count = words.next("the number of channels")
    if count not in {"0", "1", "2", "3", "4", "5", "6"}:
        raise BvhError(words.line, f"{count!r} channels: a joint has 0 to 6.")
    found: list[str] = []
    for _ in range(int(count)):
        word = words.next("a channel name")
        channel = _CANONICAL.get(word.lower())
        if channel is None or channel in found:
            problem = "unknown" if channel is None else "repeated"
            raise BvhError(
                words.line, f"{problem} channel {word!r}: valid are {', '.join(CHANNEL_NAMES)}."
            )
        found.append(channel)
    return tuple(found)
