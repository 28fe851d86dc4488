"""Parse a configuration file into a tree of plain values with the place of each.

The text is read as a stream of YAML events, and each limit is checked on the event itself: nothing
is ever expanded, and reading a file that is too deep or too long stops at its first excess.

A bare word has the meaning of the core schema of YAML 1.2, a little stricter. YAML 1.1 (which most
Python parsers follow) turns `no` into False, 12:30 into 750 and 010 into 8. Here only true and
false are booleans, only decimal numbers are numbers, and everything else is text.
"""

import json
import math
import re
import sys
from dataclasses import dataclass, field

import yaml

from app.protocol.errors import ConfigError, ConfigProblem

_INTEGER = re.compile(r"[-+]?(0|[1-9][0-9]*)")
_NUMBER = re.compile(r"[-+]?(\.[0-9]+|(0|[1-9][0-9]*)(\.[0-9]*)?)([eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"[-+]?\.?(inf|infinity|nan)", re.IGNORECASE)
_WORDS: dict[str, bool | None] = {
    "": None, "~": None, "null": None, "Null": None, "NULL": None,
    "true": True, "True": True, "TRUE": True,
    "false": False, "False": False, "FALSE": False,
}  # fmt: skip
_FORBIDDEN = re.compile(r"[\x00-\x08\x0b-\x1f\x7f\ud800-\udfff]")

# Larger integers are not read identically by every JSON parser.
MAX_INTEGER = 2**53 - 1
_MAX_DIGITS = 40
MAX_FILE_BYTES = 256 * 1024
MAX_NODES = 20_000
MAX_DEPTH = 12

Path = tuple[str | int, ...]
Plain = None | bool | int | float | str | list["Plain"] | dict[str, "Plain"]

_CORE_TAGS = frozenset(f"tag:yaml.org,2002:{kind}" for kind in ("map", "seq", "str"))
_SHOWN_DIGITS = 20
_ONE_WAY = "Write the value out at each place where it is needed."


@dataclass(frozen=True)
class ScalarProblem:
    """The reason why a scalar is invalid, what is `valid` if that is known, and the remedy."""

    message: str
    remedy: str
    valid: str | None = None


def scalar_problem(text: str, *, plain: bool) -> ScalarProblem | None:
    """Return the problem of an invalid scalar; None if the scalar is valid.

    `plain`: unquoted, so that it may be a number.
    """
    found = _FORBIDDEN.search(text)
    if found is not None:
        return ScalarProblem(
            f"The text contains the control character U+{ord(found.group()):04X}.", "Remove it."
        )
    if not plain:
        return None
    if _NOT_FINITE.fullmatch(text):
        return ScalarProblem(
            f"{text} is not a finite number.", "Give a number, or put the word in quotes."
        )
    if _NUMBER.fullmatch(text) and not _is_representable(text):
        is_whole = _INTEGER.fullmatch(text) is not None
        most = (
            f"Whole numbers go up to {MAX_INTEGER}"
            if is_whole
            else f"Numbers go up to {sys.float_info.max:.3g} and have {_MAX_DIGITS} characters at"
            " most"
        )
        return ScalarProblem(
            f"The number {text[:_SHOWN_DIGITS]}{'...' * (len(text) > _SHOWN_DIGITS)} is too large.",
            f"{most}; put it in quotes if it is a text.",
            f"at most {MAX_INTEGER if is_whole else f'{sys.float_info.max:.3g}'}",
        )
    return None


def scalar_value(text: str) -> bool | int | float | str | None:
    """Return the value of an unquoted scalar that is valid."""
    if text in _WORDS:
        return _WORDS[text]
    if _INTEGER.fullmatch(text):
        return int(text)
    if _NUMBER.fullmatch(text):
        return float(text) + 0.0  # -0.0 becomes 0.0: one number, one hash
    return text


def _is_representable(text: str) -> bool:
    if len(text) > _MAX_DIGITS:
        return False
    if _INTEGER.fullmatch(text):
        return abs(int(text)) <= MAX_INTEGER
    return math.isfinite(float(text))


@dataclass(frozen=True)
class Mark:
    """A place in the text; line and column count from 1."""

    line: int
    column: int


@dataclass
class Source:
    """The values of a file, with the place of each value and of each key.

    `problems` are those that did not stop the parsing, such as a duplicate key; `refused` are the
    places of values that were left empty because of one.
    """

    tree: Plain = None
    values: dict[Path, Mark] = field(default_factory=dict)
    keys: dict[Path, Mark] = field(default_factory=dict)
    problems: list[ConfigProblem] = field(default_factory=list)
    refused: set[Path] = field(default_factory=set)

    def place(self, path: Path, *, of_key: bool = False) -> Mark:
        """Return the place of the value (or its key); for a missing one, that of its parent."""
        marks = self.keys if of_key else self.values
        while path and path not in marks:
            path, marks = path[:-1], self.values
        return marks.get(path, Mark(0, 0))


def read_source(text: str) -> Source:
    """Parse one YAML document of mappings, lists and scalars.

    Scalars follow the core schema of YAML 1.2: only true and false are booleans, so that `no`, `on`
    and dates stay text. Raises ConfigError for invalid YAML, for anchors, aliases and tags, and for
    files beyond the limits; problems that leave the tree readable are collected in the result.
    """
    _require_size(text)
    try:
        return _Builder(text).build()
    except yaml.MarkedYAMLError as error:
        raise _syntax_error(error) from error
    except yaml.reader.ReaderError as error:
        before = text[: error.position]
        line, column = before.count("\n") + 1, len(before) - before.rfind("\n")
        message = f"The character U+{int(error.character):04X} cannot be part of a file."
        raise ConfigError(
            [ConfigProblem("", line, column, message, remedy="Remove it.")]
        ) from error


def read_json(text: str) -> Source:
    """Parse JSON with the parser of study files, which records lines: JSON is a subset of YAML.

    Raises ConfigError as `read_source` does, for a text that is not JSON with JSON's own reason.
    """
    _require_size(text)
    try:
        # In JSON, raw tabs can only be white space, but this parser requires spaces.
        return read_source(text.replace("\t", " "))
    except ConfigError as unreadable:
        try:
            json.loads(text)
        except json.JSONDecodeError as error:
            message = f"This is not JSON: {error.msg}."
            remedy = "Check commas, brackets and quotes here and in the line before."
            problem = ConfigProblem("", error.lineno, error.colno, message, remedy=remedy)
            raise ConfigError([problem]) from unreadable
        except RecursionError:
            pass
        raise


def _require_size(text: str) -> None:
    size = len(text.encode("utf-8", "surrogatepass"))
    if size <= MAX_FILE_BYTES:
        return
    raise ConfigError(
        [
            ConfigProblem(
                "",
                1,
                1,
                f"The file has {size} bytes, more than {MAX_FILE_BYTES}.",
                size,
                f"<= {MAX_FILE_BYTES}",
                "Shorten it: a file of a study, an instrument or an avatar contains settings and"
                " texts, never data.",
            )
        ]
    )


def path_text(path: Path) -> str:
    """Format a path as people write it: conditions[1].latency_ms."""
    parts = (f"[{part}]" if isinstance(part, int) else f".{part}" for part in path)
    return "".join(parts).removeprefix(".")


def _syntax_error(error: yaml.MarkedYAMLError) -> ConfigError:
    mark = error.problem_mark or error.context_mark
    line, column = (0, 0) if mark is None else (mark.line + 1, mark.column + 1)
    reason = ", ".join(part for part in (error.context, error.problem) if part)
    return ConfigError(
        [
            ConfigProblem(
                "",
                line,
                column,
                f"This is not valid YAML: {reason}.",
                remedy="Check indentation, colons and quotes here and in the line before.",
            )
        ]
    )


class _Builder:
    """Build the tree from events; the recursion is as deep as the file, so at most MAX_DEPTH."""

    def __init__(self, text: str) -> None:
        self._events = yaml.parse(text, Loader=yaml.SafeLoader)
        self._source = Source()
        self._nodes = 0

    def build(self) -> Source:
        """Parse the only document of the stream."""
        next(self._events)
        if isinstance(event := next(self._events), yaml.StreamEndEvent):
            raise self._refusal(event, (), "The file is empty.", "Give a mapping of settings.")
        self._source.tree = self._node(next(self._events), ())
        next(self._events)
        if not isinstance(event := next(self._events), yaml.StreamEndEvent):
            raise self._refusal(
                event,
                (),
                "The file contains a second document.",
                "Keep one document: remove the '---'.",
            )
        return self._source

    def _node(self, event: yaml.Event, path: Path) -> Plain:
        self._check(event, path)
        self._source.values[path] = _mark(event)
        if isinstance(event, yaml.ScalarEvent):
            return self._scalar(event, path)
        if len(path) >= MAX_DEPTH:
            raise self._refusal(
                event,
                path,
                f"This is nested more than {MAX_DEPTH} levels deep.",
                "No setting is nested that deeply: check the brackets and the indentation.",
            )
        return (
            self._sequence(path) if isinstance(event, yaml.SequenceStartEvent) else self._map(path)
        )

    def _sequence(self, path: Path) -> list[Plain]:
        values: list[Plain] = []
        while not isinstance(event := next(self._events), yaml.SequenceEndEvent):
            values.append(self._node(event, (*path, len(values))))
        return values

    def _map(self, path: Path) -> dict[str, Plain]:
        values: dict[str, Plain] = {}
        while not isinstance(event := next(self._events), yaml.MappingEndEvent):
            key = self._key(event, path)
            inner = (*path, key)
            if key in values:
                self._duplicate(event, inner)
            else:
                self._source.keys[inner] = _mark(event)
            first = self._source.values.get(inner)
            value = self._node(next(self._events), inner)
            if first is None:
                values[key] = value
            else:
                self._source.values[inner] = first
        return values

    def _key(self, event: yaml.Event, path: Path) -> str:
        self._check(event, path)
        if not isinstance(event, yaml.ScalarEvent):
            raise self._refusal(event, path, "A key is not text.", "Write keys as plain words.")
        if event.value == "<<" and event.style is None:
            raise self._refusal(event, path, "Merge keys (<<) are not allowed.", _ONE_WAY)
        problem = scalar_problem(event.value, plain=False)
        if problem is not None:
            raise self._refusal(event, path, problem.message, problem.remedy)
        return str(event.value)

    def _duplicate(self, event: yaml.Event, path: Path) -> None:
        first = self._source.keys[path].line
        self._add(
            event, path, f"The key {path[-1]!r} occurs twice; first in line {first}.",
            "Keep one of the two.",
        )  # fmt: skip

    def _scalar(self, event: yaml.ScalarEvent, path: Path) -> Plain:
        # `implicit` says whether the scalar may be read as a number; a quoted one may not.
        plain = bool(event.implicit[0]) and event.tag is None
        problem = scalar_problem(event.value, plain=plain)
        if problem is not None:
            self._add(event, path, problem.message, problem.remedy, event.value[:80], problem.valid)
            self._source.refused.add(path)
            return None
        return scalar_value(event.value) if plain else str(event.value)

    def _check(self, event: yaml.Event, path: Path) -> None:
        """Reject YAML features whose meaning is not visible in place, before they are expanded."""
        self._nodes += 1
        if self._nodes > MAX_NODES:
            raise self._refusal(
                event, path, f"The file has more than {MAX_NODES} values.", "Shorten it."
            )
        if isinstance(event, yaml.AliasEvent):
            raise self._refusal(
                event, path, f"Aliases (*{event.anchor}) are not allowed.", _ONE_WAY
            )
        anchor, tag = getattr(event, "anchor", None), getattr(event, "tag", None)
        if anchor is not None:
            raise self._refusal(event, path, f"Anchors (&{anchor}) are not allowed.", _ONE_WAY)
        if tag is not None and tag not in _CORE_TAGS:
            raise self._refusal(
                event, path, f"The tag {tag!r} is not allowed.", "Write the plain value instead."
            )

    def _add(
        self,
        event: yaml.Event,
        path: Path,
        message: str,
        remedy: str,
        value: object = None,
        valid: object = None,
    ) -> None:
        mark = _mark(event)
        self._source.problems.append(
            ConfigProblem(path_text(path), mark.line, mark.column, message, value, valid, remedy)
        )

    def _refusal(self, event: yaml.Event, path: Path, message: str, remedy: str) -> ConfigError:
        mark = _mark(event)
        problem = ConfigProblem(path_text(path), mark.line, mark.column, message, remedy=remedy)
        return ConfigError([*self._source.problems, problem])


def _mark(event: yaml.Event) -> Mark:
    start = event.start_mark
    return Mark(0, 0) if start is None else Mark(start.line + 1, start.column + 1)
