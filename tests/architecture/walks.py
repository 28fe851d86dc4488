"""Four pieces of data on their way through the running code, and how often they come back.

`drive.py` sends each through the real application in one process (TestClient, real SQLite) and
notes whose functions are called. What counts, before and after any change alike:

- an entry is a call of a function, method, lambda or comprehension that is defined in a file of
  `app`, in any thread: nothing of `app` is left out, neither guards nor clock nor database.
  Calls from one file into itself are one entry; a coroutine that goes on is no new call.
- computing that the server gives to a process of its own happens in a thread here.
- threads that also call functions of `app` while nobody asks anything of the server are left out:
  they work by a timer.
- files: how many different ones are entered, in the order of their first entry.
- steps: the different pairs (file, next file). What a loop repeats counts once, so that figures do
  not depend on how long the data are.
- returns: the steps that lead to a file which was entered, and left, before.

The first run, which loads and keeps things, is not counted. Of the next three the one with the
fewest steps is: threads take turns as they like.
"""

import json
import os
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from textwrap import wrap
from typing import Any

DRIVER = Path(__file__).with_name("drive.py")
ROUNDS = 3


@dataclass(frozen=True)
class Walk:
    """The files one piece of data entered, in order, and its steps between them."""

    files: list[str]
    steps: int
    returns: int

    def as_json(self) -> dict[str, Any]:
        """For `json.dumps`."""
        return {"count": len(self.files), "steps": self.steps, "returns": self.returns} | {
            "files": self.files
        }


def walk_of(entered: Sequence[str]) -> Walk:
    """Count files, steps and returns of a sequence of entries."""
    files: dict[str, None] = {}
    steps: set[tuple[str, str]] = set()
    returns = 0
    before = ""
    for file in entered:
        if before and (before, file) not in steps:
            steps.add((before, file))
            returns += file in files
        files.setdefault(file)
        before = file
    return Walk(list(files), len(steps), returns)


def walks(root: Path, rounds: int = ROUNDS) -> dict[str, Walk]:
    """Each walk through the tree at `root`, by name."""
    environment = {
        name: value for name, value in os.environ.items() if not name.startswith("REEMBODY_")
    }
    told = subprocess.run(
        [sys.executable, "-P", str(DRIVER), str(rounds)],
        cwd=root,
        env={**environment, "PYTHONPATH": str(root)},
        stdout=subprocess.PIPE,
        text=True,
        check=True,
    ).stdout
    return {
        name: min((walk_of(entered) for entered in runs), key=lambda walk: (walk.steps, walk.files))
        for name, runs in json.loads(told).items()
    }


def written(walked: dict[str, Walk]) -> str:
    """The walks as docs/architecture.md shows them: files in order, those of a folder together."""
    parts = []
    for name, walk in walked.items():
        way = []
        for folder, files in groupby(walk.files, key=lambda file: str(Path(file).parent)):
            names = [Path(file).stem for file in files]
            inside = f"{folder}/".removeprefix("app/")
            way.append(inside + (names[0] if len(names) == 1 else "{" + ", ".join(names) + "}"))
        figures = f"{len(walk.files)} files, {walk.steps} steps, {walk.returns} returns"
        lines = wrap(" > ".join(way), 98, break_long_words=False, break_on_hyphens=False)
        parts.append("\n".join([f"{name}: {figures}", *(f"  {line}" for line in lines)]))
    return "\n\n".join(parts)
