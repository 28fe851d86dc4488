"""Tests that the structure of the tree stays within its limits and is measured correctly."""

from collections.abc import Callable
from pathlib import Path
from types import MappingProxyType

import pytest

from tests.architecture.imports import circles, python_imports, typescript_imports
from tests.architecture.measure import Measure, layering, measure
from tests.architecture.measure import python_code_lines as python_lines
from tests.architecture.measure import typescript_code_lines as typescript_lines
from tests.architecture.trees import REPOSITORY

LIMITS = MappingProxyType(
    {
        "circles": 0,
        "upward_imports": 0,
        "floors": 7,
        "files_le_50": 49,
    }
)
"""The greatest allowed figures; `tests.architecture.measure` defines them."""
Build = Callable[[dict[str, str]], Path]


@pytest.fixture(scope="module")
def present() -> Measure:
    """Provide the measures of the current tree."""
    return measure(REPOSITORY)


@pytest.fixture
def build(tmp_path: Path) -> Build:
    """Provide a function that creates a small tree of files with these contents."""

    def built(files: dict[str, str]) -> Path:
        for folder in ("app/features", "frontend/src"):
            (tmp_path / folder).mkdir(parents=True, exist_ok=True)
        for name, text in files.items():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / name).write_text(text, encoding="utf-8")
        return tmp_path

    return built


@pytest.mark.parametrize("figure", LIMITS)
def test_the_structure_stays_within_its_limits(present: Measure, figure: str) -> None:
    """The numbers of circles, upward imports, floors and small files stay within their limits."""
    assert getattr(present, figure) <= LIMITS[figure]


def test_every_kind_of_import_counts(build: Build) -> None:
    """Lazy, type-only, relative and whole-package imports close circles."""
    root = build(
        {
            "app/__init__.py": "",
            "app/a.py": "def f():\n    import app.b\n",
            "app/b.py": "import typing\nif typing.TYPE_CHECKING:\n    from app import a",
            "app/room/__init__.py": "from .inner import X",
            "app/room/inner.py": "from app.room import Y\nfrom .. import a",
        }
    )
    graph = python_imports(root)
    assert graph["app/room/inner.py"] == {"app/room/__init__.py", "app/a.py"}
    assert circles(graph) == [
        ["app/a.py", "app/b.py"],
        ["app/room/__init__.py", "app/room/inner.py"],
    ]


def test_loading_a_module_by_name_is_an_import(build: Build) -> None:
    """`import_module` and `__import__` close circles and run up like any import."""
    root = build(
        {
            "app/a.py": "from importlib import import_module\nimport_module('app.b')\n",
            "app/b.py": "import importlib\nimportlib.import_module('app.a')\n",
            "app/c.py": "__import__('app.a')\n__import__('os')\nprint('app.b')\n",
        }
    )
    graph = python_imports(root)
    assert circles(graph) == [["app/a.py", "app/b.py"]]
    assert graph["app/c.py"] == {"app/a.py"}


def test_a_module_is_not_its_package(build: Build) -> None:
    """Importing a module is not an import of the `__init__` above it, nor is a name in a text."""
    root = build(
        {
            "app/room/__init__.py": "from app.room.inner import X",
            "app/room/inner.py": '"""from app.room import X"""\nfrom app.room.other import Y',
            "app/room/other.py": "from app.room import inner",
        }
    )
    assert circles(python_imports(root)) == [["app/room/inner.py", "app/room/other.py"]]


def test_pages_import_each_other_in_every_form(build: Build) -> None:
    """Type imports, re-exports, `import()`, aliases and folders count as imports between pages.

    Tests and comments do not.
    """
    root = build(
        {
            "frontend/src/a.ts": 'import type {\n  B,\n} from "./b";\nimport "./style.css";',
            "frontend/src/b.ts": 'export { C } from "@shared/c";',
            "frontend/src/shared/c.tsx": 'const page = lazy(() => import("../folder"));',
            "frontend/src/folder/index.ts": '// import "../a";\nexport const one = 1;',
            "frontend/src/a.test.ts": 'import "./a";',
        }
    )
    assert typescript_imports(root) == {
        "frontend/src/a.ts": {"frontend/src/b.ts"},
        "frontend/src/b.ts": {"frontend/src/shared/c.tsx"},
        "frontend/src/shared/c.tsx": {"frontend/src/folder/index.ts"},
        "frontend/src/folder/index.ts": set(),
    }


def test_circles_are_strongly_connected_components() -> None:
    """Two loops that share a node are one circle; one that merely leads to another is not."""
    graph = {
        "a": {"b", "c"},
        "b": {"a"},
        "c": {"a", "d"},
        "d": {"e"},
        "e": {"d", "alone"},
        "alone": set[str](),
    }
    assert circles(graph) == [["a", "b", "c"], ["d", "e"]]


def test_rooms_without_a_loop_are_above_their_imports() -> None:
    """Rooms without a loop are one floor above the highest room they import."""
    pair = [("file", "file")]
    found = layering({("a", "b"): pair, ("b", "c"): pair, ("a", "c"): pair}, "abcd")
    assert found.upward == []
    assert found.floor_of == {"a": 3, "b": 2, "c": 1, "d": 1}


def test_the_lighter_arrow_of_a_loop_runs_back_up() -> None:
    """In a loop, the arrow with fewer imports runs up, and its imports are listed."""
    down = [("a/1", "b/1"), ("a/2", "b/1")]
    found = layering({("a", "b"): down, ("b", "a"): [("b/2", "a/1")]}, "ab")
    assert found.upward == [("b/2", "a/1")]
    assert found.floor_of == {"a": 2, "b": 1}


def test_wings_are_measured_inside_and_above_the_platform(build: Build) -> None:
    """Imports from the platform to a wing, and loops within a wing, run up.

    The platform is a floor.
    """
    root = build(
        {
            "app/features/__init__.py": "",
            "app/features/care/rights/service.py": "import app.features.care.network",
            "app/features/care/network.py": "import app.platform.live",
            "app/features/record/cockpit/view.py": "import app.features.record.tablet.service\n"
            "import app.features.record.tablet.call\nimport app.platform.live",
            "app/features/record/tablet/service.py": "import app.features.record.cockpit.view",
            "app/features/record/tablet/call.py": "import app.platform.live",
            "app/platform/live.py": "def lazily():\n    import app.features.care.network",
        }
    )
    found = measure(root)
    assert found.rooms == {
        "app/features/care": 2,
        "app/features/record": 2,
        "app/platform": 1,
    }
    assert found.floors_inside_wings == {"care": 2, "record": 2}
    assert found.upward_inside_wings == {"care": 0, "record": 1}
    assert found.upward_imports == 2
    assert ("app/platform/live.py", "app/features/care/network.py") in found.upward_import_list
    assert ("app/features/record/tablet/service.py", "app/features/record/cockpit/view.py") in (
        found.upward_import_list
    )


def test_small_files_are_counted_by_physical_lines(build: Build) -> None:
    """A file of 50 physical lines is small, one of 51 is not, and `__init__.py` does not count."""
    root = build(
        {
            "app/__init__.py": "",
            "app/fifty.py": "a = 1\n" * 50,
            "app/more.py": "a = 1\n" * 51,
            "frontend/src/one.ts": "export const one = 1;\n",
            "frontend/src/one.test.ts": "export const two = 2;\n",
        }
    )
    found = measure(root)
    assert (found.files_le_50, found.files_le_50_typescript) == (1, 1)
    assert found.code_lines == 50 + 51 + 1


def test_code_is_neither_blank_nor_comment_nor_docstring() -> None:
    """Blank lines, comments and docstrings are not code; a multi-line string value is."""
    python = '"""A.\n\nB."""\n\nx = """a\n\n  b"""  # why\n# why\n"""Of x."""\ny = [\n    x,\n]\n'
    assert python_lines(python) == 5
    typescript = "/** A.\n * B.\n */\nconst a = 1; // why\n\n// why\n{/* in JSX */}\nconst b = a;\n"
    assert typescript_lines(typescript) == 2
