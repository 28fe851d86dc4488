"""Run `reembody walk` in tests, and write walks for it."""

import json
from pathlib import Path
from typing import Any

import numpy as np
from typer.testing import CliRunner, Result

from app.cli.commands import app
from app.cli.errors import UNUSABLE
from app.science.walking.synthetic import POPULATIONS, person_of, straight_path, walk_along

QUICK = ("--entries", 300, "--k", 30, "--reading", "time-aware")


def run(*arguments: object) -> Result:
    """Run the command and return its result, whatever it is."""
    return CliRunner().invoke(app, ["walk", *(str(argument) for argument in arguments)])


def figures(*arguments: object) -> dict[str, Any]:
    """Run the command with --json and return what it prints."""
    result = run(*arguments, "--json")
    assert result.exit_code == 0, result.output
    found = json.loads(result.stdout)
    assert isinstance(found, dict)
    return found


def refusal(*arguments: object) -> str:
    """Run the command, which refuses, and return what it says."""
    result = run(*arguments)
    assert result.exit_code == UNUSABLE, result.output
    assert result.stdout == ""
    return result.stderr


def write_walks(folder: Path, people: range) -> list[Path]:
    """Write three straight walks for each person, one file per walk."""
    files = []
    for number in people:
        rng = np.random.default_rng((4, number))
        person = person_of(POPULATIONS[0], number, rng)
        for at, length in enumerate((1.0, 2.0, 3.0)):
            track = walk_along(person, straight_path(length), rng)
            rows = [f"{number},{t:.4f},{x:.4f},{y:.4f}" for t, (x, y) in
                    zip(track.times_s[::2], track.xy_m[::2], strict=True)]  # fmt: skip
            path = folder / f"walker-{number}-{at}.csv"
            path.write_text("\n".join(["subject,time_s,x_m,y_m", *rows]) + "\n")
            files.append(path)
    return files
