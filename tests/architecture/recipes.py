"""Apply a recipe of CONTRIBUTING.md to a copy of the tree, and count the files it touches.

A recipe is data: whole files that it adds, and exact edits of existing files. A test applies
it, runs what it should enable, and limits the count:

    PHASE = Recipe(
        name="task phase",
        heading="Add a task phase",
        added={"study_configs/texts/new.yaml": "..."},
        edited={"app/protocol/procedure.py": [after("class HeightStep(Strict):\\n", "...")]},
    )

    def test_a_task_phase_is_added(tmp_path: Path) -> None:
        tree = PHASE.apply(tmp_path)               # app, study_configs, migrations, pyproject.toml
        tree.run_module("app.cli", "openapi")      # generators write into the copy
        assert tree.evaluate("import app.x; answer = app.x.y()") == ...   # in a process of its own
        assert PHASE.unnamed_files() == set()      # CONTRIBUTING.md names every file
        assert tree.count()["edited"] <= 5         # {"recipe": "task phase", "edited": 4, ...}

The resulting tree is compared with the current one to count files, so that what a
generator or a script changed counts, too. Tests and generated files (`is_apart`) do not count.
"""

import json
import os
import shutil
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, TypedDict

from tests.architecture.trees import REPOSITORY

COPIED = ("app", "study_configs", "migrations", "pyproject.toml")
"""The contents of every copy. A file that a recipe edits elsewhere is copied individually."""
GENERATED = frozenset(
    {
        "docs/data-dictionary.md",
        "frontend/src/shared/session/registries.generated.ts",
        "frontend/src/shared/api/schema.d.ts",
    }
)
"""Files that a command writes; a test of each says which, and fails when it is out of date."""
_LEFT_OUT = shutil.ignore_patterns("static", "*.pyc.*")  # built pages; half-written bytecode
_TIMEOUT_S = 120.0

Json = Any
"""A value that `json.loads` returns."""


class RecipeError(Exception):
    """Raised if a recipe no longer fits the tree; names the missing file or text."""


class Count(TypedDict):
    """The number of files that a recipe edits and adds, without tests and generated files."""

    recipe: str
    edited: int
    added: int


@dataclass(frozen=True)
class Edit:
    """The replacement of `old` by `new` in a file, which must contain `old` exactly once."""

    old: str
    new: str


def after(old: str, added: str) -> Edit:
    """Return the edit that inserts `added` directly after `old`."""
    return Edit(old, old + added)


def before(old: str, added: str) -> Edit:
    """Return the edit that inserts `added` directly before `old`."""
    return Edit(old, added + old)


@dataclass(frozen=True)
class Recipe:
    """The changes that a newcomer makes by hand: `added` files, and edits of `edited` ones.

    All paths are relative to the repository, with slashes. `heading`: that of the recipe's section
    in CONTRIBUTING.md, without its number signs.
    """

    name: str
    heading: str
    added: Mapping[str, str] = field(default_factory=dict)
    edited: Mapping[str, Sequence[Edit]] = field(default_factory=dict)

    def apply(self, folder: Path, *also: str) -> "Tree":
        """Return a copy of the tree with this recipe applied, created below the empty `folder`.

        Args:
            folder: an existing folder, such as pytest's `tmp_path`.
            also: files or folders that the copy needs besides `COPIED`.

        Raises:
            RecipeError: a file to add exists already, or an edit's text is not in its file exactly
                once.
            FileNotFoundError: a file to edit is missing.
        """
        files = {**self._edited_files(), **self._added_files()}
        tree = _copied(self.name, folder, [*COPIED, *also, *self.edited])
        for path, text in files.items():
            tree.write(path, text)
        return tree

    def unnamed_files(self) -> set[str]:
        """Return the files of this recipe that its section of CONTRIBUTING.md does not name.

        A file counts as named if its path is, and an added file also if its folder's path is.
        """
        section = section_of(self.heading)
        return {path for path in self.edited if not is_apart(path) and path not in section} | {
            path
            for path in self.added
            if not is_apart(path) and path.rpartition("/")[0] not in section
        }

    def _added_files(self) -> Mapping[str, str]:
        for path in self.added:
            if (REPOSITORY / path).exists():
                raise RecipeError(
                    f"The recipe {self.name!r} adds {path}, which is there already. "
                    "Let it add a file of another name, or edit this one."
                )
        return self.added

    def _edited_files(self) -> Mapping[str, str]:
        files = dict[str, str]()
        for path, edits in self.edited.items():
            text = (REPOSITORY / path).read_text(encoding="utf-8")
            for edit in edits:
                if (found := text.count(edit.old)) != 1:
                    raise RecipeError(
                        f"The recipe {self.name!r} looks for {edit.old!r} in {path}, which has it "
                        f"{found} times; it must be there once. Bring the recipe, and its section "
                        "in CONTRIBUTING.md, in line with the file."
                    )
                text = text.replace(edit.old, edit.new)
            files[path] = text
        return files


@dataclass(frozen=True)
class Tree:
    """A copy of the repository's tree below `root`, with a recipe applied."""

    recipe: str
    root: Path

    def read(self, path: str) -> str:
        """Return the text of a file of the copy."""
        return (self.root / path).read_text(encoding="utf-8")

    def write(self, path: str, text: str) -> None:
        """Write a file of the copy, creating its folders."""
        target = self.root / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text, encoding="utf-8")

    def evaluate(self, script: str) -> Json:
        """Return the value that `script` assigns to `answer`, in a process that imports the copy.

        Raises RecipeError with the process's output if it fails.
        """
        told = (
            "import app, json, pathlib\n"
            f"assert pathlib.Path(app.__file__).is_relative_to({str(self.root)!r}), app.__file__\n"
            f"{script}\n"
            "print()\nprint(json.dumps(answer))\n"
        )
        lines = self._run("-c", told).splitlines()
        return json.loads(lines[-1])

    def run_module(self, module: str, *arguments: str) -> str:
        """Return the output of `python -m module arguments`, run inside the copy."""
        return self._run("-m", module, *arguments)

    def changed(self) -> tuple[set[str], set[str]]:
        """Return the edited and the added files, including generated ones."""
        edited, added = set[str](), set[str]()
        for file in self.root.rglob("*"):
            if not file.is_file() or "__pycache__" in file.parts:
                continue
            path = file.relative_to(self.root).as_posix()
            original = REPOSITORY / path
            if not original.exists():
                added.add(path)
            elif original.read_bytes() != file.read_bytes():
                edited.add(path)
        return edited, added

    def count(self) -> Count:
        """Count the files that differ from the repository's, without tests and generated ones."""
        edited, added = (sum(not is_apart(path) for path in some) for some in self.changed())
        return {"recipe": self.recipe, "edited": edited, "added": added}

    def _run(self, *arguments: str) -> str:
        ran = subprocess.run(
            [sys.executable, *arguments],
            cwd=self.root,
            env={**os.environ, "PYTHONPATH": str(self.root), "PYTHONDONTWRITEBYTECODE": "1"},
            capture_output=True,
            text=True,
            timeout=_TIMEOUT_S,
            check=False,
        )
        if ran.returncode != 0:
            raise RecipeError(
                f"With the recipe {self.recipe!r} applied, python {arguments[0]} "
                f"{arguments[1][:200]} fails:\n{ran.stdout}{ran.stderr}"
            )
        return ran.stdout


def is_apart(path: str) -> bool:
    """Return whether a file does not count: a test, or one that a command generates."""
    name = path.rpartition("/")[2]
    return path.startswith("tests/") or ".test." in name or path in GENERATED


def section_of(heading: str) -> str:
    """Return the section of CONTRIBUTING.md under this heading, up to the next heading.

    Raises RecipeError if there is none.
    """
    text = (REPOSITORY / "CONTRIBUTING.md").read_text(encoding="utf-8")
    for section in text.split("\n#")[1:]:
        first, _, rest = section.partition("\n")
        if first.lstrip("# ") == heading:
            return rest
    raise RecipeError(f"CONTRIBUTING.md has no heading {heading!r}.")


def _copied(recipe: str, folder: Path, paths: Sequence[str]) -> Tree:
    root = folder / "tree"
    for path in paths:
        source, target = REPOSITORY / path, root / path
        if target.exists():
            continue
        if not source.exists():
            raise FileNotFoundError(f"The recipe {recipe!r} needs {path}, which is not there.")
        target.parent.mkdir(parents=True, exist_ok=True)
        if source.is_dir():
            shutil.copytree(source, target, ignore=_LEFT_OUT)
        else:
            shutil.copy2(source, target)
    return Tree(recipe, root)
