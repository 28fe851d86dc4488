"""Published tables against which the statistics are tested.

Those of R and of papers come from the shared data, which are not part of the repository; those that
pingouin contains are read from its folder, without importing it.
"""

import csv
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from app.science.statistics import cells_of
from app.science.statistics.arrays import FloatArray
from app.science.statistics.tidy import Cells

#: Ratings of 3 wines by 12 people, from pingouin's documentation of `friedman`.
WINE = np.array(
    [
        (10, 8, 7, 9, 7, 4, 5, 6, 5, 10, 4, 7),
        (7, 5, 8, 6, 5, 7, 9, 6, 4, 6, 7, 3),
        (8, 5, 6, 4, 7, 5, 3, 7, 6, 4, 4, 3),
    ],
    dtype=np.float64,
).T
#: scipy's documentation of `page_trend_test`: 10 students rate tutorial, lecture, seminar.
TEACHING = np.array(
    [
        (3, 4, 3), (2, 2, 4), (3, 3, 5), (1, 3, 2), (2, 3, 2),
        (2, 4, 5), (1, 2, 4), (3, 4, 4), (2, 4, 5), (1, 3, 4),
    ],
    dtype=np.float64,
)  # fmt: skip


def rows(path: Path) -> list[dict[str, str]]:
    """Return the rows of a CSV file as dictionaries by column."""
    return list(csv.DictReader(path.read_text(encoding="utf-8-sig").splitlines()))


def pingouin_table(name: str) -> list[dict[str, str]]:
    """Return the rows of a table in pingouin; skip the test if it is not installed."""
    spec = find_spec("pingouin")
    if spec is None or not spec.submodule_search_locations:
        pytest.skip("pingouin is not installed; it carries this table")
    return rows(Path(spec.submodule_search_locations[0]) / "datasets" / f"{name}.csv")


def cells(table: list[dict[str, str]], subject: str, within: list[str], measure: str) -> Cells:
    """Return a long table as an array of cells."""
    return cells_of(
        [row[subject] for row in table],
        {factor: [row[factor] for row in table] for factor in within},
        [row[measure] for row in table],
    )


def wide(table: list[dict[str, str]], columns: list[str] | None = None) -> FloatArray:
    """Return a wide table as an array, NaN where a cell is empty."""
    return np.array([[float(row[name] or "nan") for name in columns or list(row)] for row in table])
