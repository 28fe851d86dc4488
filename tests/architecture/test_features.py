"""Tests that features are imported from outside only through the names they export."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
ROUTERS = "app/api/router.py"
"""It imports routers from the features' `endpoints`: packages do not export HTTP."""


def imports() -> Iterator[tuple[str, str, list[str]]]:
    """Yield (importing file, module, its names) for every import of a feature from outside."""
    for file in sorted((REPOSITORY / "app").glob("**/*.py")):
        path = file.relative_to(REPOSITORY).as_posix()
        own = ".".join(path.split("/")[:4])
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            found: list[tuple[str, list[str]]] = []
            if isinstance(node, ast.ImportFrom) and node.module is not None:
                found = [(node.module, [name.name for name in node.names])]
            elif isinstance(node, ast.Import):
                found = [(name.name, []) for name in node.names]
            for module, names in found:
                if f"{module}.".startswith("app.features.") and not f"{module}.".startswith(
                    f"{own}."
                ):
                    yield path, module, names


@cache
def offered(module: str) -> frozenset[str]:
    """Return the names in the `__all__` of a package, or no names if it has none."""
    face = REPOSITORY / module.replace(".", "/") / "__init__.py"
    if not face.is_file():
        return frozenset()
    for node in ast.parse(face.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return frozenset(ast.literal_eval(node.value))
    return frozenset()


def test_features_are_imported_through_their_all() -> None:
    """Code outside a feature imports only names in its package's `__all__`.

    A feature's heavy half is a package with an `__all__` of its own. Only routers are imported from
    the modules that create them.
    """
    strangers = [
        f"{file} imports {module}: {', '.join(names) or 'as a whole'}"
        for file, module, names in imports()
        if not (file == ROUTERS and module.endswith("endpoints"))
        and not (names and offered(module).issuperset(names))
    ]
    assert strangers == []
