"""Tests that code outside of a science package imports only what its `__init__` exports."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import app.science

SCIENCE = Path(app.science.__file__).parent
APP, TESTS = SCIENCE.parent, Path(__file__).parents[1]
MODULES_WITH_EXPORTS = {"app.science.instruments.table"}
"""Modules that export names themselves, not through their package, since they load pandas."""


def _name(path: Path) -> str:
    parts = path.relative_to(APP.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


PACKAGES = {_name(path) for path in SCIENCE.rglob("__init__.py")}
HOMES = {_name(path): path for path in SCIENCE.rglob("*.py")}


@cache
def _exported_names(module: str) -> set[str] | None:
    """Return the names that `__all__` lists, or None if the module has no `__all__`."""
    for node in ast.parse(HOMES[module].read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            return set(ast.literal_eval(node.value))
    return None


def _imports(path: Path) -> Iterator[tuple[str, str, int]]:
    """Yield the module, name and line of each import from science in a file."""
    text = path.read_text(encoding="utf-8")
    for node in ast.walk(ast.parse(text)) if "app.science" in text else ():
        if isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.startswith("app.science"):
                    yield alias.name, "", node.lineno
        elif isinstance(node, ast.ImportFrom) and (node.module or "").startswith("app.science"):
            for alias in node.names:
                yield str(node.module), alias.name, node.lineno


def _is_inside(importer: str, module: str) -> bool:
    """Return whether a module may import another's internals.

    It may import those of its own package, and kernels may import each other: no `__init__` can
    export kernels, as importing one loads the compiler.
    """
    package = module if module in PACKAGES else module.rpartition(".")[0]
    kernels = module.endswith("_kernels") and importer.startswith("app.science.")
    return f"{importer}.".startswith(f"{package}.") or kernels


def _is_exported(module: str, name: str) -> bool:
    if f"{module}.{name}" in PACKAGES:
        return True
    if module in PACKAGES or module in MODULES_WITH_EXPORTS:
        return name in (_exported_names(module) or ())
    # A module directly in app.science is public.
    return module.count(".") == 2 and module in HOMES


def _importers() -> Iterator[tuple[str, Path]]:
    for path in (*APP.rglob("*.py"), *TESTS.rglob("*.py")):
        if not path.is_relative_to(TESTS / "science"):
            yield _name(path), path


def test_outsiders_import_exported_names_only() -> None:
    """Every import of science from outside of a package takes a name that it exports."""
    deeper = [
        f"{importer}:{line} imports {name} from {module}"
        for importer, path in _importers()
        for module, name, line in _imports(path)
        if not _is_inside(importer, module) and not _is_exported(module, name)
    ]
    assert deeper == []


@pytest.mark.parametrize("package", sorted(PACKAGES))
def test_packages_export_what_they_import(package: str) -> None:
    """Each package has a docstring, and its `__all__` lists exactly what its `__init__` imports."""
    tree = ast.parse(HOMES[package].read_text(encoding="utf-8"))
    assert ast.get_docstring(tree)
    imported = {
        alias.name for node in tree.body if isinstance(node, ast.ImportFrom) for alias in node.names
    }
    assert imported == (_exported_names(package) or set())
