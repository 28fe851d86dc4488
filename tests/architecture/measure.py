"""Compute the structure of a tree in five figures, each defined here, without running anything.

circles
    Sets of files that import each other in a loop: strongly connected components of more than one
    file in the import graph of `app/**/*.py` and `frontend/src/**/*.ts(x)` (tests left out). Every
    import counts; `tests.architecture.imports` defines what one is.
upward_imports, floors
    These describe `app/features`. Its rooms are the folders and files directly below it and, if it
    exists,
    `app/platform`. An arrow leads from one room to another that it imports; its weight is the
    number of pairs of files that import each other across. The rooms are ordered so that as few
    arrows as can be found run back up (of such orders, with the fewest imports): if the arrows form
    no loop, none do. If all of them are wings (`WINGS`) and the platform, their order is given. The
    `upward_imports` are the imports of the arrows that run back up. Without these, a room is one
    floor above the highest room that it imports, and on floor 1 if it imports none;
    `floors` is the number of floors. If a room is a wing (`WINGS`), the features inside it
    are rooms in the same way: their upward imports are added, their floors are listed by wing.
files_le_50
    Python files of `app`, without `__init__.py`, of at most 50 physical lines.
code_lines
    Lines of `app/**/*.py` and of `frontend/src` (tests and `GENERATED` files left out;
    translations are data files and not counted) that contain code: not blank, not only a comment,
    not part of a docstring (a string that is a statement of its own).
"""

import ast
import io
import tokenize
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from tests.architecture.imports import (
    Graph,
    circles,
    python_files,
    python_imports,
    typescript_files,
    typescript_imports,
)

FEATURES = "app/features"
PLATFORM = "app/platform"
WINGS = ("care", "results", "record", "design", "movement", "people")
"""The wings from the top down; features are inside them."""
SMALL_LINES = 50
GENERATED = ("schema.d.ts", ".generated.ts")
SILENT = {
    tokenize.COMMENT,
    tokenize.NL,
    tokenize.NEWLINE,
    tokenize.INDENT,
    tokenize.DEDENT,
    tokenize.ENCODING,
    tokenize.ENDMARKER,
}
Arrows = dict[tuple[str, str], list[tuple[str, str]]]


@dataclass(frozen=True)
class Layering:
    """Rooms on floors, 1 being the ground, and the imports (file, file) that run back up."""

    floor_of: dict[str, int]
    upward: list[tuple[str, str]]

    @property
    def floors(self) -> int:
        """Return the number of floors."""
        return max(self.floor_of.values(), default=0)


@dataclass(frozen=True)
class Measure:
    """The five figures and their parts; the module docstring defines them."""

    circles: int
    upward_imports: int
    floors: int
    files_le_50: int
    code_lines: int
    circles_python: int
    circles_typescript: int
    circle_members: list[list[str]]
    upward_import_list: list[tuple[str, str]]
    rooms: dict[str, int]
    floors_inside_wings: dict[str, int]
    upward_inside_wings: dict[str, int]
    files_python: int
    files_typescript: int
    files_le_50_typescript: int
    code_lines_python: int
    code_lines_typescript: int

    def as_json(self) -> dict[str, Any]:
        """Return the figures for `json.dumps`."""
        return asdict(self)


def measure(root: Path) -> Measure:
    """Measure the tree at `root`."""
    python, typescript = python_imports(root), typescript_imports(root)
    circles_python, circles_typescript = circles(python), circles(typescript)
    whole = layering(arrows(python, FEATURES, also=(PLATFORM,)), rooms(python, FEATURES, PLATFORM))
    wings = {name: f"{FEATURES}/{name}" for name in WINGS if f"{FEATURES}/{name}" in whole.floor_of}
    inside = {
        name: layering(arrows(python, wing), rooms(python, wing)) for name, wing in wings.items()
    }
    upward = [*whole.upward, *(pair for one in inside.values() for pair in one.upward)]
    texts_python = texts(root, python_files(root))
    texts_typescript = texts(root, typescript_files(root))
    lines_python = sum(map(python_code_lines, texts_python.values()))
    lines_typescript = sum(
        typescript_code_lines(text)
        for file, text in texts_typescript.items()
        if not file.endswith(GENERATED)
    )
    modules = (text for file, text in texts_python.items() if not file.endswith("__init__.py"))
    return Measure(
        circles=len(circles_python) + len(circles_typescript),
        upward_imports=len(upward),
        floors=whole.floors,
        files_le_50=small(modules),
        code_lines=lines_python + lines_typescript,
        circles_python=len(circles_python),
        circles_typescript=len(circles_typescript),
        circle_members=[*circles_python, *circles_typescript],
        upward_import_list=upward,
        rooms=whole.floor_of,
        floors_inside_wings={name: one.floors for name, one in inside.items()},
        upward_inside_wings={name: len(one.upward) for name, one in inside.items()},
        files_python=len(texts_python),
        files_typescript=len(texts_typescript),
        files_le_50_typescript=small(texts_typescript.values()),
        code_lines_python=lines_python,
        code_lines_typescript=lines_typescript,
    )


def texts(root: Path, files: Iterable[str]) -> dict[str, str]:
    """Return the contents of files, by path."""
    return {file: (root / file).read_text(encoding="utf-8") for file in files}


def small(contents: Iterable[str]) -> int:
    """Return the number of texts with at most `SMALL_LINES` physical lines."""
    return sum(len(text.splitlines()) <= SMALL_LINES for text in contents)


def rooms(graph: Graph, folder: str, *also: str) -> set[str]:
    """Return the rooms directly below a folder, without its `__init__.py`, and other folders."""
    found = {room_of(file, folder, also) for file in graph}
    return {room for room in found if room is not None}


def room_of(file: str, folder: str, also: Sequence[str] = ()) -> str | None:
    """Return the folder or file below `folder` to which a file belongs, or None outside."""
    for other in also:
        if file.startswith(f"{other}/"):
            return other
    if not file.startswith(f"{folder}/"):
        return None
    name, _, deeper = file.removeprefix(f"{folder}/").partition("/")
    if name == "__init__.py":
        return None
    return f"{folder}/{name}" if deeper else f"{folder}/{name}".removesuffix(".py")


def arrows(graph: Graph, folder: str, also: Sequence[str] = ()) -> Arrows:
    """Return the pairs of files that import each other across rooms, by (room, imported room)."""
    found: Arrows = {}
    for file, targets in sorted(graph.items()):
        here = room_of(file, folder, also)
        for target in sorted(targets):
            there = room_of(target, folder, also)
            if here is not None and there is not None and here != there:
                found.setdefault((here, there), []).append((file, target))
    return found


def layering(between: Arrows, every: Iterable[str]) -> Layering:
    """Assign each room to a floor.

    The best order is sought by moving one room at a time to its best place until no move helps
    (sifting), unless the order of wings and platform is given. It starts with the rooms that import
    most others, then by name, so that the same tree always gives the same floors.
    """
    start = sorted(every, key=lambda room: (-sum(here == room for here, _ in between), room))
    given = [*(f"{FEATURES}/{wing}" for wing in WINGS), PLATFORM]
    order = sifted(start, between)
    if set(start) <= set(given):
        order = [room for room in given if room in start]
    place = {room: at for at, room in enumerate(order)}
    upward = [
        pair
        for (here, there), pairs in sorted(between.items())
        if place[here] > place[there]
        for pair in pairs
    ]
    floor_of: dict[str, int] = {}
    for room in reversed(order):
        below = (there for here, there in between if here == room and place[there] > place[room])
        floor_of[room] = 1 + max((floor_of[there] for there in below), default=0)
    return Layering(floor_of, upward)


def sifted(order: list[str], between: Arrows) -> list[str]:
    """Return an order in which moving one room leaves no fewer arrows, or imports, running up."""
    better = True
    while better:
        better = False
        for room in sorted(order):
            rest = [other for other in order if other != room]
            # If the room is first, all arrows to it run up; each room that then moves before it
            # changes sides.
            costs = [(0, 0)]
            for other in rest:
                arrives, leaves = between.get((other, room), []), between.get((room, other), [])
                arrows_up, imports_up = costs[-1]
                costs.append(
                    (
                        arrows_up + bool(leaves) - bool(arrives),
                        imports_up + len(leaves) - len(arrives),
                    )
                )
            lowest = costs.index(min(costs))
            if costs[lowest] < costs[order.index(room)]:
                order = [*rest[:lowest], room, *rest[lowest:]]
                better = True
    return order


def python_code_lines(text: str) -> int:
    """Return how many lines of a Python file contain code."""
    strings = {
        line
        for node in ast.walk(ast.parse(text))
        if isinstance(node, ast.Expr)
        and isinstance(node.value, ast.Constant)
        and isinstance(node.value.value, str)
        for line in range(node.lineno, (node.end_lineno or node.lineno) + 1)
    }
    code: set[int] = set()
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type not in SILENT:
            code.update(range(token.start[0], token.end[0] + 1))
    blank = {at for at, line in enumerate(text.splitlines(), 1) if not line.strip()}
    return len(code - strings - blank)


def typescript_code_lines(text: str) -> int:
    """Return how many lines of a TypeScript file contain code, without whole-line comments."""
    code, inside = 0, False
    for line in map(str.strip, text.splitlines()):
        if inside or line.startswith(("/*", "{/*")):
            inside = "*/" not in line
        elif line and not line.startswith("//"):
            code += 1
    return code


TABLE: Mapping[str, str] = {
    "circles": "sets of files that import each other in a loop",
    "upward_imports": "imports of app/features that run back up, inside its wings too",
    "floors": "floors on which the rooms of app/features stand, with app/platform",
    "files_le_50": "Python files of at most 50 lines, without __init__.py",
    "code_lines": "lines of code in app and frontend/src, without blanks, comments, docstrings",
}


def table(result: Measure) -> str:
    """Return the figures with their definitions and their parts, as text."""
    lines = [f"{getattr(result, key):>8}  {key:<15} {words}" for key, words in TABLE.items()]
    members = [f"{len(circle)} files from {circle[0]}" for circle in result.circle_members]
    inside = [
        f"{wing}: {floors} floors, {result.upward_inside_wings[wing]} imports upward"
        for wing, floors in result.floors_inside_wings.items()
    ]
    lines += [
        "",
        f"circles: {result.circles_python} Python, {result.circles_typescript} TypeScript",
        *(f"  {member}" for member in members),
        f"rooms: {len(result.rooms)}",
        *(f"  {one}" for one in inside),
        *(f"  upward: {here} -> {there}" for here, there in result.upward_import_list),
        f"small files of frontend/src: {result.files_le_50_typescript}",
        f"code lines: {result.code_lines_python} Python, {result.code_lines_typescript} TypeScript",
    ]
    return "\n".join(lines)
