"""Follow four pieces of data through the running code and count how often they return to a file.

`drive.py` sends each through the real application in one process (TestClient, real SQLite) and
records whose functions are called. The counting rules:

- an entry is a call of a function, method, lambda or comprehension that is defined in a file of
  `app`, in any thread: nothing of `app` is left out, neither guards nor clock nor database. Calls
  within one file are one entry; a resumed coroutine is not a new call.

- computations that the server gives to a separate process run in a thread here.

- threads that also call functions of `app` while the server gets no requests are left out: they are
  driven by a timer.

- files: how many different ones are entered, in the order of their first entry.

- steps: the different pairs (file, next file). A repetition in a loop counts once, so that figures
  do not depend on the length of the data.

- returns: the steps that lead to a file which was entered, and left, before.

The first run, which loads and caches things, is not counted. Of the next three the one with the
fewest steps is: the order of threads varies.
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
    """The files that one piece of data entered, in order, and its steps between them."""

    files: list[str]
    steps: int
    returns: int

    def as_json(self) -> dict[str, Any]:
        """Return the walk for `json.dumps`."""
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
    """Run each walk through the tree at `root` and return them by name."""
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
    """Format the walks as docs/architecture.md shows them: files in order, grouped by folder."""
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
