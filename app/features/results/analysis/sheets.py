"""Write a figure's rows as CSV, with comment lines that describe them.

The file begins with lines that start with `#`: the study, the kind of data, the filter, the
caption. Readers skip them by their usual option (`comment="#"`). Whether a row is simulated is also
in its first columns, where no reader loses it.
"""

import csv
import io
import textwrap
from collections.abc import Sequence
from typing import Any

import numpy as np
import pandas as pd

from app.features.results.analysis.figures import Drawing
from app.features.results.analysis.material import Material

_WIDTH = 100
_RUN_AS_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def sheet_of(drawing: Drawing, material: Material) -> bytes:
    """Return a drawing's rows as CSV: UTF-8, LF, empty cells for missing values.

    Text that a spreadsheet would run as a formula begins with an apostrophe.
    """
    lines = _head(drawing, material)
    written = io.StringIO()
    writer = csv.writer(written, lineterminator="\n")
    data = drawing.data.reset_index(drop=True)
    writer.writerow(["study_key", "kind", "simulated", *data.columns])
    own = (material.protocol.key, material.kind, str(material.kind == "simulated").lower())
    for row in data.itertuples(index=False):
        writer.writerow([*own, *_cells(row)])
    return ("\n".join(lines) + "\n" + written.getvalue()).encode()


def _head(drawing: Drawing, material: Material) -> list[str]:
    origin = {
        "people": "Data of people.",
        "simulated": "SIMULATED DATA: made by a simulation, not by people.",
        "test": "TEST DATA: from test sessions, not data of a study.",
    }[material.kind]
    texts = [f"Reembody, study {material.protocol.key}. {origin}", drawing.title]
    texts += textwrap.wrap(drawing.caption, _WIDTH)
    if drawing.empty:
        texts.append(drawing.empty)
    return [f"# {line}" for line in texts]


def _cells(row: Sequence[Any]) -> list[str]:
    return [_cell(value) for value in row]


def _cell(value: Any) -> str:
    if pd.isna(value):
        return ""
    if isinstance(value, str):
        return f"'{value}" if value.startswith(_RUN_AS_FORMULA) else value
    if isinstance(value, bool | np.bool_):
        return str(bool(value)).lower()
    if isinstance(value, float) and value.is_integer():
        return str(int(value))
    return str(value)
