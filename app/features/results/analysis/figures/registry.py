"""The registry of the dashboard's figures, in the order in which they are drawn.

To add a figure, write its builder in a file of this folder and add its entry to `FIGURES`: the
dashboard then draws it in its group, and its rows can be downloaded.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import pandas as pd

from app.features.record.ledger import planned_slots
from app.features.results.analysis.figures.achieved import achieved_drawing
from app.features.results.analysis.figures.body_map import joint_error_body_drawing
from app.features.results.analysis.figures.by_body import by_body_drawings
from app.features.results.analysis.figures.by_demographics import demographics_drawings
from app.features.results.analysis.figures.completions import completions_drawing, learning_drawing
from app.features.results.analysis.figures.contact_map import contact_map_drawing
from app.features.results.analysis.figures.contacts import contacts_drawing
from app.features.results.analysis.figures.crossings import crossings_drawings
from app.features.results.analysis.figures.drawing import Drawing, Group
from app.features.results.analysis.figures.embodiment import embodiment_drawings
from app.features.results.analysis.figures.exclusions import exclusions_drawing
from app.features.results.analysis.figures.fingers import joint_error_fingers_drawings, mark_fingers
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
    """The data that pass a filter, and the valid rows of their tables, selected on first use.

    `every_body`: the data of every body that pass it, where the filter is for one body.
    """

    def __init__(
        self, filtered: Material, *, invalid: bool, every_body: Material | None = None
    ) -> None:
        self.filtered = filtered
        self.invalid = invalid
        self._every_body = filtered if every_body is None else every_body

    def by_body(self, group: Group) -> Iterator[Drawing]:
        """Yield the measures of a group with each body, where a study varies bodies."""
        return by_body_drawings(self._every_body, group, invalid=self.invalid)

    @cached_property
    def phases(self) -> pd.DataFrame:
        """Return the valid rows of the table of phases."""
        return self.counting(self.filtered.phases)

    @cached_property
    def errors(self) -> pd.DataFrame:
        """Return the valid rows of the table of joint errors."""
        return self.counting(self.filtered.errors)

    @cached_property
    def contacts(self) -> pd.DataFrame:
        """Return the valid rows of the table of contacts."""
        return self.counting(self.filtered.contacts)

    def crossings(self) -> Iterator[Drawing]:
        """Yield the figures of crossings, where the study has a road."""
        if self.filtered.protocol.road is not None:
            yield from crossings_drawings(self.counting(self.filtered.crossings))

    @cached_property
    def touching(self) -> pd.DataFrame:
        """Return the valid phases, each with whether its fingers were recorded."""
        return mark_fingers(self.phases, self.filtered.quality, self.filtered.contacts)

    def counting(self, table: pd.DataFrame) -> pd.DataFrame:
        """Return the valid rows of a table."""
        return self.filtered.counting(table, invalid=self.invalid)


@dataclass(frozen=True)
class Figure:
    """One figure of the dashboard, or a family of figures from one builder.

    Attributes:
        group: The group on the page; the figures of a group are drawn together.
        keys: What the keys of its drawings begin with, so that one is found without drawing all.
        draw: Makes the drawings, each with its key, title and caption, from the valid rows.
        of_boxes: Its data are of tasks at boxes: it is empty for ever where a study has none.
    """

    group: Group
    keys: tuple[str, ...]
    draw: Callable[[Rows], Iterator[Drawing]]
    of_boxes: bool = False

    def may_draw(self, key: str) -> bool:
        """Return whether one of its drawings may have this key."""
        return key.startswith(self.keys)

    @classmethod
    def one(
        cls,
        group: Group,
        key: str,
        draw: Callable[[Rows], Drawing],
        *,
        wide: bool = False,
        of_boxes: bool = False,
    ) -> "Figure":
        """Create the entry of a builder that returns one drawing, with this key.

        `wide`: the drawing needs the full width of the page.
        """

        def drawings(rows: Rows) -> Iterator[Drawing]:
            drawing = draw(rows)
            yield drawing.of_group(group, wide=wide or drawing.wide)

        return cls(group, (key,), drawings, of_boxes)


def orders_of(protocol: StudyProtocol) -> list[str]:
    """Return every order of latencies in the design, as "0 125 350"."""
    levels = protocol.levels
    return sorted(
        {" ".join(levels[name] for name in order) for order, _ in planned_slots(protocol)}
    )


FIGURES: tuple[Figure, ...] = (
    Figure("embodiment", ("embodiment_",), lambda rows: rows.by_body("embodiment")),
    Figure(
        "embodiment",
        ("embodiment_",),
        lambda rows: embodiment_drawings(rows.counting(rows.filtered.scores)),
    ),
    Figure(
        "answers",
        ("likert",),
        lambda rows: likert_drawings(
            rows.counting(rows.filtered.answers), rows.filtered.instruments
        ),
    ),
    Figure(
        "tasks", ("completions_bodies", "contact_time_bodies"), lambda rows: rows.by_body("tasks")
    ),
    Figure("tasks", ("crossing_",), Rows.crossings),
    Figure.one(
        "tasks",
        "completions",
        lambda rows: completions_drawing(rows.phases).tested_as("completions"),
        of_boxes=True,
    ),
    Figure.one("tasks", "learning", lambda rows: learning_drawing(rows.phases), of_boxes=True),
    Figure.one(
        "tasks",
        "contacts",
        lambda rows: contacts_drawing(rows.touching, rows.contacts).tested_as("contact_time"),
        wide=True,
        of_boxes=True,
    ),
    Figure.one(
        "tasks",
        "contacts_map",
        lambda rows: contact_map_drawing(rows.touching, rows.contacts),
        of_boxes=True,
    ),
    Figure("movement", ("joint_error_bodies",), lambda rows: rows.by_body("movement")),
    Figure.one("movement", "joint_error_body", lambda rows: joint_error_body_drawing(rows.errors)),
    Figure.one(
        "movement",
        "joint_error_parts",
        lambda rows: joint_error_drawing(rows.errors).tested_as("joint_error"),
    ),
    Figure.one("movement", "achieved_latency", lambda rows: achieved_drawing(rows.phases)),
    Figure.one(
        "movement",
        "joint_error_blocks",
        lambda rows: joint_error_blocks_drawing(rows.errors),
        of_boxes=True,
    ),
    Figure.one(
        "movement",
        "joint_error_course",
        lambda rows: joint_error_course_drawing(rows.counting(rows.filtered.courses)),
        of_boxes=True,
    ),
    Figure.one(
        "movement",
        "joint_error_joints",
        lambda rows: joint_error_map_drawing(rows.errors),
        wide=True,
    ),
    Figure(
        "movement", ("joint_error_fingers",), lambda rows: joint_error_fingers_drawings(rows.errors)
    ),
    Figure(
        "demographics",
        ("demographics_",),
        lambda rows: demographics_drawings(
            rows.counting(rows.filtered.scores),
            rows.counting(rows.filtered.answers),
            rows.filtered.instruments,
        ),
    ),
    Figure.one(
        "quality", "quality", lambda rows: quality_drawing(rows.counting(rows.filtered.quality))
    ),
    Figure.one(
        "quality",
        "exclusions",
        lambda rows: exclusions_drawing(
            rows.filtered.sessions, rows.filtered.phases, rows.filtered.scores
        ),
    ),
    Figure.one(
        "quality",
        "alarms",
        lambda rows: alarms_drawing(rows.filtered.alarms, len(rows.filtered.sessions)),
    ),
    Figure.one(
        "progress",
        "progress_time",
        lambda rows: progress_time_drawing(
            rows.filtered.sessions, len(planned_slots(rows.filtered.protocol))
        ),
    ),
    Figure.one(
        "progress",
        "progress",
        lambda rows: progress_drawing(
            rows.filtered.sessions, orders_of(rows.filtered.protocol), blinded=rows.filtered.blinded
        ),
    ),
)
