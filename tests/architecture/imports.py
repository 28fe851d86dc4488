"""Read from a tree's sources which file imports which, without importing or running anything.

A graph names files by their path from the tree's root, and contains for each the files it imports.
Every import counts, wherever it is: at the top, inside a function, under TYPE_CHECKING, by its name
in `import_module`, and TypeScript's `import type`. Naming a module is an import of that module
alone: Python also runs the `__init__` of each package above it, but no line of the importing file
depends on those. A name that is assembled at run time is not followed.
"""

import ast
import posixpath
import re
from collections.abc import Iterator, Mapping
from pathlib import Path

Graph = dict[str, set[str]]

TYPESCRIPT_TESTS = re.compile(r"\.test\.tsx?$|/(__tests__|test|tests|testing)/")
ALIASES = {"@shared/": "frontend/src/shared/", "@charts/": "frontend/src/charts/"}
"""The `paths` of frontend/tsconfig.json."""
FROM = re.compile(
    r"""^[ \t]*(?:import|export)\b[^;'"`]*?\bfrom\s*["']([^"']+)["']"""  # import ... from "x"
    r"""|^[ \t]*import\s*["']([^"']+)["']"""  # import "x"
    r"""|\bimport\(\s*["']([^"']+)["']""",  # import("x"), lazy or as a type
    re.MULTILINE,
)


def python_files(root: Path) -> list[str]:
    """Return the paths of `app/**/*.py`, sorted."""
    return sorted(path.relative_to(root).as_posix() for path in (root / "app").rglob("*.py"))


def typescript_files(root: Path) -> list[str]:
    """Return the paths of `frontend/src/**/*.ts` and `.tsx` without tests, sorted."""
    found = (path.relative_to(root).as_posix() for path in (root / "frontend/src").rglob("*.ts*"))
    return sorted(
        path
        for path in found
        if path.endswith((".ts", ".tsx")) and not TYPESCRIPT_TESTS.search(path)
    )


def python_imports(root: Path) -> Graph:
    """Return the import graph of `app/**/*.py`.

    `import package` is an import of its `__init__`, and so is `from package import name`, unless
    `name` is a submodule: then it is an import of the submodule.
    """
    files = python_files(root)
    by_module = {_module(file): file for file in files}
    graph: Graph = {}
    for file in files:
        tree = ast.parse((root / file).read_text(encoding="utf-8"))
        named = {by_module[module] for module in _named(tree, file, by_module)}
        graph[file] = named - {file}
    return graph


def typescript_imports(root: Path) -> Graph:
    """Return the import graph of `frontend/src`: imports, re-exports and `import()`, with types."""
    files = typescript_files(root)
    known = set(files)
    graph: Graph = {}
    for file in files:
        text = (root / file).read_text(encoding="utf-8")
        named = (next(filter(None, found.groups())) for found in FROM.finditer(text))
        graph[file] = {
            target for name in named if (target := _resolve(name, file, known)) not in (None, file)
        }
    return graph


def circles(graph: Mapping[str, set[str]]) -> list[list[str]]:
    """Return the strongly connected components of more than one node, the largest first.

    Each is a set of files of which every one reaches every other along imports. Kosaraju: searching
    the graph in the order in which the searches of its reverse finish, last first, each search
    finds one component.
    """
    reverse: Graph = {node: set() for node in graph}
    for node, targets in graph.items():
        for target in targets:
            reverse[target].add(node)
    finished: list[str] = []
    seen: set[str] = set()
    for node in sorted(graph):
        finished += _search(node, reverse, seen)
    seen.clear()
    components = [_search(node, graph, seen) for node in reversed(finished)]
    found = [sorted(component) for component in components if len(component) > 1]
    return sorted(found, key=lambda circle: (-len(circle), circle))


def _search(start: str, graph: Mapping[str, set[str]], seen: set[str]) -> list[str]:
    """Return the unseen nodes that can be reached, depth first, in the order they are finished."""
    if start in seen:
        return []
    seen.add(start)
    finished: list[str] = []
    path = [(start, iter(sorted(graph[start])))]
    while path:
        node, targets = path[-1]
        target = next((one for one in targets if one not in seen), None)
        if target is None:
            path.pop()
            finished.append(node)
        else:
            seen.add(target)
            path.append((target, iter(sorted(graph[target]))))
    return finished


def _module(file: str) -> str:
    return file.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def _named(tree: ast.AST, file: str, modules: Mapping[str, str]) -> Iterator[str]:
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in modules)
        elif isinstance(node, ast.ImportFrom):
            source = _absolute(node, file)
            for alias in node.names:
                submodule = f"{source}.{alias.name}"
                if submodule in modules:
                    yield submodule
                elif source in modules:
                    yield source
        elif isinstance(node, ast.Call) and (loaded := _loaded_by_name(node)) in modules:
            yield loaded


def _loaded_by_name(call: ast.Call) -> str:
    """Return the module named in `import_module` or `__import__`; empty for other calls."""
    function = call.func.attr if isinstance(call.func, ast.Attribute) else None
    function = call.func.id if isinstance(call.func, ast.Name) else function
    match call.args:
        case [ast.Constant(value=str(name)), *_] if function in ("import_module", "__import__"):
            return name
        case _:
            return ""


def _absolute(node: ast.ImportFrom, file: str) -> str:
    if not node.level:
        return node.module or ""
    package = file.split("/")[: -node.level]
    return ".".join([*package, *([node.module] if node.module else [])])


def _resolve(name: str, file: str, known: set[str]) -> str | None:
    for alias, folder in ALIASES.items():
        if name.startswith(alias):
            base = folder + name.removeprefix(alias)
            break
    else:
        if not name.startswith("."):
            return None
        base = posixpath.normpath(posixpath.join(posixpath.dirname(file), name))
    ends = ("", ".ts", ".tsx", "/index.ts", "/index.tsx")
    return next((base + end for end in ends if base + end in known), None)
