"""Find duplicate lines in a tree.

A line counts when it contains more than punctuation, is not a comment, and is not part of an
import. If `RUN` such lines in a row, white space folded, occur at another place too, in the same
file or a later one, the later lines are *repeated*. Lines of the same shape with other names are
not: a table of similar entries is data. Generated files and frozen migrations are left out.
"""

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from tests.architecture.measure import GENERATED

RUN = 6
FOLDERS = ("app", "frontend/src", "tests")
SUFFIXES = (".py", ".ts", ".tsx", ".css", ".mjs", ".js")
LEFT_OUT = frozenset({"static", "__pycache__", "node_modules"})
TYPESCRIPT_IMPORT = re.compile(r"^(?:import|export)\b[^;]*?\bfrom\s+\"[^\"]+\";?", re.M)
COMMENT = re.compile(r"^(?:#|//|/?\*)")
Line = tuple[int, str]


@dataclass(frozen=True)
class Repeat:
    """A run of `lines` significant lines at `again` that also occurs earlier, at `first`."""

    first: str
    again: str
    lines: int


def repeats(root: Path) -> list[Repeat]:
    """Return every maximal run that occurred earlier in the tree at `root`, longest first."""
    return found({name: significant(name, text) for name, text in sources(root)})


def sources(root: Path) -> Iterator[tuple[str, str]]:
    """Yield the path from `root` and the text of every file that counts, sorted by path."""
    for folder in FOLDERS:
        for path in sorted((root / folder).rglob("*")):
            name = path.relative_to(root)
            is_source = path.suffix in SUFFIXES and not path.name.endswith(GENERATED)
            if is_source and not LEFT_OUT.intersection(name.parts):
                yield name.as_posix(), path.read_text(encoding="utf-8")


def significant(name: str, text: str) -> list[Line]:
    """Return the number and the folded text of each line of a file that counts."""
    imported = _import_lines(name, text)
    folded = ((n, " ".join(line.split())) for n, line in enumerate(text.splitlines(), 1))
    return [
        (n, line)
        for n, line in folded
        if n not in imported and re.search(r"\w", line) and not COMMENT.match(line)
    ]


def found(files: Mapping[str, list[Line]]) -> list[Repeat]:
    """Return the repeats in lines given by file, longest first; a line is in at most one."""
    seen: dict[tuple[str, ...], tuple[str, int]] = {}
    result = []
    for name, lines in files.items():
        texts = [text for _, text in lines]
        at = 0
        while at + RUN <= len(texts):
            window = tuple(texts[at : at + RUN])
            first = seen.setdefault(window, (name, at))
            if first == (name, at) or (first[0] == name and first[1] + RUN > at):
                at += 1
                continue
            length = _common(files[first[0]], first[1], lines, at)
            result.append(
                Repeat(_place(first[0], files[first[0]], first[1]), _place(name, lines, at), length)
            )
            at += length
    return sorted(result, key=lambda one: (-one.lines, one.again))


def _common(before: list[Line], start: int, lines: list[Line], at: int) -> int:
    """Return how many lines from `start` on equal those from `at` on, without overlap."""
    length = 0
    while (
        start + length < len(before)
        and at + length < len(lines)
        and before[start + length][1] == lines[at + length][1]
        and (before is not lines or start + length < at)
    ):
        length += 1
    return length


def _place(name: str, lines: list[Line], at: int) -> str:
    return f"{name}:{lines[at][0]}"


def _import_lines(name: str, text: str) -> set[int]:
    """Return the numbers of the lines that belong to an import."""
    if name.endswith(".py"):
        return {
            number
            for node in ast.walk(ast.parse(text))
            if isinstance(node, ast.Import | ast.ImportFrom)
            for number in range(node.lineno, (node.end_lineno or node.lineno) + 1)
        }
    return {
        number
        for match in TYPESCRIPT_IMPORT.finditer(text)
        for number in range(
            text.count("\n", 0, match.start()) + 1, text.count("\n", 0, match.end()) + 2
        )
    }
