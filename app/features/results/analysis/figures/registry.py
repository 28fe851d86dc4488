"""The registry of the dashboard's figures, in the order in which they are drawn.

Whoever adds a figure writes its builder in a file of this folder, and its entry in `FIGURES`: the
dashboard draws it in its group, and its rows can be downloaded.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from app.features.record.ledger import planned_slots
from app.features.results.analysis.figures.achieved import achieved_drawing
from app.features.results.analysis.figures.body_map import joint_error_body_drawing
from app.features.results.analysis.figures.completions import completions_drawing, learning_drawing
from app.features.results.analysis.figures.contact_map import contact_map_drawing
from app.features.results.analysis.figures.contacts import contacts_drawing
from app.features.results.analysis.figures.drawing import Drawing, Group
from app.features.results.analysis.figures.embodiment import embodiment_drawings
from app.features.results.analysis.figures.exclusions import exclusions_drawing
from app.features.results.analysis.figures.joint_error_blocks import joint_error_blocks_drawing
from app.features.results.analysis.figures.joint_error_course import joint_error_course_drawing
from app.features.results.analysis.figures.joint_errors import (
    joint_error_drawing,
    joint_error_map_drawing,
)
from app.features.results.analysis.figures.likert import likert_drawings
from app.features.results.analysis.figures.progress import progress_drawing, progress_time_drawing
from app.features.results.analysis.figures.quality import alarms_drawing, quality_drawing
from app.features.results.analysis.material import Material
from app.protocol import StudyProtocol


class Rows:
    """What a filter left, and of its tables the rows that count, taken out when first wanted."""

    def __init__(self, left: Material, *, invalid: bool) -> None:
        self.left = left
        self.invalid = invalid

    @cached_property
    def phases(self) -> pd.DataFrame:
        """Phases that count."""
        return self.counting(self.left.phases)

    @cached_property
    def errors(self) -> pd.DataFrame:
        """Joint errors that count."""
        return self.counting(self.left.errors)

    @cached_property
    def contacts(self) -> pd.DataFrame:
        """Contacts that count."""
        return self.counting(self.left.contacts)

    def counting(self, table: pd.DataFrame) -> pd.DataFrame:
        """Of a table the rows that count."""
        return self.left.counting(table, invalid=self.invalid)


@dataclass(frozen=True)
class Figure:
    """One figure of the dashboard, or a family of figures that one builder gives.

    Attributes:
        group: of the page; the figures of a group are drawn together.
        draw: makes the drawings, each with its key, title and caption, of the rows that count.
    """

    group: Group
    draw: Callable[[Rows], Iterator[Drawing]]

    @classmethod
    def one(cls, group: Group, draw: Callable[[Rows], Drawing], *, wide: bool = False) -> "Figure":
        """The entry of a builder that gives one drawing; `wide`: it needs the page's width."""

        def drawings(rows: Rows) -> Iterator[Drawing]:
            drawing = draw(rows)
            yield drawing.of_group(group, wide=wide or drawing.wide)

        return cls(group, drawings)


def orders_of(protocol: StudyProtocol) -> list[str]:
    """Every order of latencies that the design has, as "0 125 350"."""
    latencies = {condition.key: condition.latency_ms for condition in protocol.conditions}
    slots = planned_slots(protocol)
    return sorted({" ".join(f"{latencies[name]:g}" for name in order) for order, _ in slots})


FIGURES: tuple[Figure, ...] = (
    Figure("embodiment", lambda rows: embodiment_drawings(rows.counting(rows.left.scores))),
    Figure(
        "answers",
        lambda rows: likert_drawings(rows.counting(rows.left.answers), rows.left.instruments),
    ),
    Figure.one("tasks", lambda rows: completions_drawing(rows.phases)),
    Figure.one("tasks", lambda rows: learning_drawing(rows.phases)),
    Figure.one("tasks", lambda rows: contacts_drawing(rows.phases, rows.contacts), wide=True),
    Figure.one("tasks", lambda rows: contact_map_drawing(rows.phases, rows.contacts)),
    Figure.one("movement", lambda rows: joint_error_body_drawing(rows.errors)),
    Figure.one("movement", lambda rows: joint_error_drawing(rows.errors)),
    Figure.one("movement", lambda rows: achieved_drawing(rows.phases)),
    Figure.one("movement", lambda rows: joint_error_blocks_drawing(rows.errors)),
    Figure.one(
        "movement", lambda rows: joint_error_course_drawing(rows.counting(rows.left.courses))
    ),
    Figure.one("movement", lambda rows: joint_error_map_drawing(rows.errors), wide=True),
    Figure.one("quality", lambda rows: quality_drawing(rows.counting(rows.left.quality))),
    Figure.one(
        "quality",
        lambda rows: exclusions_drawing(rows.left.sessions, rows.left.phases, rows.left.scores),
    ),
    Figure.one("quality", lambda rows: alarms_drawing(rows.left.alarms, len(rows.left.sessions))),
    Figure.one(
        "progress",
        lambda rows: progress_time_drawing(
            rows.left.sessions, len(planned_slots(rows.left.protocol))
        ),
    ),
    Figure.one(
        "progress",
        lambda rows: progress_drawing(
            rows.left.sessions, orders_of(rows.left.protocol), blinded=rows.left.blinded
        ),
    ),
)
