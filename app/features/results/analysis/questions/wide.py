"""One row per participant and one column per cell of the design, as JASP and SPSS want it.

The values are those that are tested: means over the valid rows of valid completed sessions. The
names of columns are made for these programs: letters, digits and underscores, at most 64
characters, beginning with a letter (SPSS Statistics, Variable Names).
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass

import pandas as pd
from sqlalchemy.orm import Session

from app.features.results.analysis.material import Material, read_material
from app.features.results.analysis.questions.measures import Measure, completed, measures_of
from app.features.results.analysis.schemas import DashboardKind

LONGEST_NAME = 64
PERSON = ("participant_code", "kind", "simulated", "avatar", "order")
"""Columns before the cells: who it is, of which kind, and the order of their conditions."""


@dataclass(frozen=True)
class WideColumn:
    """The meaning of a column: the measure in one limb at one level, and one body if there are
    several.
    """

    name: str
    measure: str
    limb: str
    condition: str
    unit: str
    about: str


@dataclass(frozen=True, eq=False)
class WideTable:
    """The rows, with the columns of `PERSON` first, and the meaning of every other column."""

    frame: pd.DataFrame
    columns: tuple[WideColumn, ...]

    @property
    def names(self) -> list[str]:
        """Return the names of all columns, in their order."""
        return [*PERSON, *(column.name for column in self.columns)]


def wide_table(db: Session, study_key: str, kind: DashboardKind) -> WideTable:
    """Return the values of valid completed participants; a cell without a value is missing.

    Raises NotFound for an unknown study.
    """
    return wide_table_of(read_material(db, study_key, kind, names=()))


def wide_table_of(material: Material) -> WideTable:
    """Return the wide table of a study whose tables can be read."""
    sessions = completed(material).sessions
    frame = sessions.loc[:, ["participant_code", "kind", "simulated", "avatar", "order"]]
    frame = frame.drop_duplicates("participant_code").set_index("participant_code").sort_index()
    described: list[WideColumn] = []
    cells: dict[str, pd.Series] = {}
    for body, measure in _measures(material):
        for limb in measure.limbs:
            table = measure.table(limb)
            for level, key in zip(measure.levels, table.columns, strict=True):
                condition = " ".join(filter(None, (measure.factor.words(level), body)))
                name = _name(measure.key, limb, condition, cells)
                cells[name] = table[key].reindex(frame.index)
                described.append(
                    WideColumn(name, measure.title, limb, condition, measure.unit, measure.about)
                )
    whole = pd.concat([frame, pd.DataFrame(cells, index=frame.index)], axis=1).reset_index()
    return WideTable(whole, tuple(described))


def _measures(material: Material) -> Iterator[tuple[str, Measure]]:
    """Yield every measure, of each body apart where conditions differ in their bodies."""
    if not material.bodies:
        yield from (("", measure) for measure in measures_of(material))
    for body in material.bodies:
        yield from ((body, measure) for measure in measures_of(material.of_body(body)))


def _name(measure: str, limb: str, condition: str, taken: dict[str, pd.Series]) -> str:
    """Return a name of letters, digits and underscores that no other column has."""
    end = re.sub(r"\W", "", f"_{limb}_{condition}".replace(" ", ""), flags=re.ASCII)
    start = re.sub(r"\W", "_", measure, flags=re.ASCII)
    start = start if start[:1].isalpha() else f"m_{start}"
    name = start[: LONGEST_NAME - len(end)] + end
    number = 2
    while name in taken:
        suffix = f"_{number}"
        name = start[: LONGEST_NAME - len(end) - len(suffix)] + end + suffix
        number += 1
    return name
