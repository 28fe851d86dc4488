"""Collect the figures that fault tests report and print them together at the end of a run.

`note(20, "burst", "acknowledged and lost", 0)` adds a line to the table; the first number is the
row of the fault matrix in docs/faults.md. `./run test tests/faults` prints the table; with
`REEMBODY_FAULT_FIGURES=FILE` it is also written as JSON.
"""

import json
import os
from collections.abc import Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

from tests.support.shared_run import locked, run_folder

FILE_VARIABLE = "REEMBODY_FAULT_FIGURES"


@dataclass(frozen=True)
class FaultFigure:
    """One figure that a fault test measured, with the row of its fault in the matrix."""

    row: int
    fault: str
    figure: str
    value: str


def note(row: int, fault: str, figure: str, value: object) -> None:
    """Append a figure to the run's table, under its fault's row."""
    told = FaultFigure(
        row, fault, figure, f"{value:.3g}" if isinstance(value, float) else str(value)
    )
    file = run_folder() / "fault-figures.jsonl"
    with locked(file.with_suffix(".lock")), file.open("a") as lines:
        lines.write(json.dumps(asdict(told)) + "\n")


def noted() -> list[FaultFigure]:
    """Return all figures reported in this run, sorted by row."""
    file = run_folder() / "fault-figures.jsonl"
    if not file.exists():
        return []
    told = [FaultFigure(**json.loads(line)) for line in file.read_text().splitlines()]
    return sorted(told, key=lambda one: one.row)


def as_table(told: Sequence[FaultFigure]) -> list[str]:
    """Format the figures as lines for the terminal."""
    widths = [max(len(getattr(one, name)) for one in told) for name in ("fault", "figure")]
    return [
        f"{one.row:>3}  {one.fault:<{widths[0]}}  {one.figure:<{widths[1]}}  {one.value}"
        for one in told
    ]


def save(told: Sequence[FaultFigure]) -> None:
    """Write the figures as JSON to the file named by the environment variable, if it is set."""
    if os.environ.get(FILE_VARIABLE):
        rows = [asdict(one) for one in told]
        Path(os.environ[FILE_VARIABLE]).write_text(json.dumps(rows, indent=2))
