"""The recipes of CONTRIBUTING.md work, and touch no more files than they may."""

import dataclasses
from pathlib import Path

import pytest

from tests.architecture.recipes import Edit, Recipe, RecipeError, Tree, after

EXAMPLE = Recipe(
    name="example",
    heading="Recipes",
    added={"app/words.py": "WORD = 'new'\n", "tests/test_words.py": ""},
    edited={
        "app/clock.py": [after("import time\n", "\nfrom app.words import WORD as WORD\n")],
        "docs/data-dictionary.md": [Edit("# Data dictionary", "# Words")],
    },
)
"""Adds a module to the server and edits one; the test and the generated file do not count."""


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Tree:
    """The tree with the example in it."""
    return EXAMPLE.apply(tmp_path_factory.mktemp("example"))


def test_a_recipe_is_applied_to_a_copy_and_counted(example: Tree) -> None:
    """The copy runs with the edit in it, and one edited and one added file are counted."""
    assert example.evaluate("import app.clock; answer = app.clock.WORD") == "new"
    assert example.changed() == (
        {"app/clock.py", "docs/data-dictionary.md"},
        {"app/words.py", "tests/test_words.py"},
    )
    assert example.count() == {"recipe": "example", "edited": 1, "added": 1}
    assert EXAMPLE.unnamed_files() == {"app/clock.py", "app/words.py"}


def test_a_recipe_that_no_longer_fits_says_where(tmp_path: Path) -> None:
    """A text to edit that is not in its file once, and a file to add that is there, are errors."""
    strays = {"app/clock.py": [Edit("import timing", "import time")]}
    with pytest.raises(RecipeError, match=r"'import timing' in app/clock.py, which has it 0 times"):
        dataclasses.replace(EXAMPLE, edited=strays).apply(tmp_path)
    with pytest.raises(RecipeError, match=r"adds app/clock.py, which is there already"):
        dataclasses.replace(EXAMPLE, added={"app/clock.py": ""}).apply(tmp_path)


def test_a_script_that_fails_shows_its_output(example: Tree) -> None:
    """What the copy's process wrote is in the error, so that the recipe can be mended."""
    with pytest.raises(RecipeError, match=r"No module named 'app.absent'"):
        example.evaluate("import app.absent; answer = 1")
