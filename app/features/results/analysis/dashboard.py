"""The dashboard of a study: its valid rows, drawn, group by group.

People's, simulated and test sessions are never drawn together. In a blinded study only completed
sessions are drawn, so that nobody who still runs a session can learn its latencies here.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from functools import cached_property

import pandas as pd
from sqlalchemy.orm import Session

from app.features.record.ledger import planned_slots
from app.features.results.analysis.figures import (
    Drawing,
    achieved_drawing,
    alarms_drawing,
    completions_drawing,
    contact_map_drawing,
    contacts_drawing,
    embodiment_drawings,
    exclusions_drawing,
    joint_error_blocks_drawing,
    joint_error_body_drawing,
    joint_error_course_drawing,
    joint_error_drawing,
    joint_error_map_drawing,
    learning_drawing,
    likert_drawings,
    progress_drawing,
    progress_time_drawing,
    quality_drawing,
)
from app.features.results.analysis.material import Material, n_not_valid, read_material
from app.features.results.analysis.schemas import (
    NO_FILTER,
    DashboardFigures,
    DashboardKind,
    FigureFilter,
    FigureGroup,
    FigureView,
    FilterChoices,
)
from app.protocol import StudyProtocol

TITLE_PREFIX = {"people": "", "simulated": "Simulated: ", "test": "Test: "}
NONE_COUNTS = "There are data, but none that count: choose all rows to see them."
BLINDED_NOTE = "The study is blinded: measures of sessions that are still open are left out."


def build_dashboard(
    db: Session, study_key: str, kind: DashboardKind, chosen: FigureFilter = NO_FILTER
) -> DashboardFigures:
    """Every figure of a study's sessions of one kind; raises NotFound for an unknown study."""
    return dashboard_of(read_material(db, study_key, kind), chosen)


def dashboard_of(
    material: Material, chosen: FigureFilter = NO_FILTER, group: FigureGroup | None = None
) -> DashboardFigures:
    """The figures of what a filter leaves, of one group or of all, and what else could be chosen.

    Only the tables that these figures are made of are wanted of `material`.
    """
    left = material.chosen(chosen)
    return DashboardFigures(
        kind=material.kind,
        simulated=material.kind == "simulated",
        n_sessions=len(left.sessions),
        n_completed=int((left.sessions["status"] == "completed").sum()),
        n_not_valid=n_not_valid(left.sessions),
        avatar=sorted(set(left.sessions["avatar"])),
        filter=chosen,
        choices=_choices(material),
        figures=[_view(drawing) for drawing in drawings_of(material, chosen, group)],
    )


def drawings_of(
    material: Material, chosen: FigureFilter = NO_FILTER, group: FigureGroup | None = None
) -> Iterator[Drawing]:
    """The drawings one after the other, marked with what they show; of all groups unless named."""
    prefix = TITLE_PREFIX[material.kind]
    note = f"{chosen.words()} {BLINDED_NOTE if material.blinded else ''}".strip()
    rows = _Rows(material.chosen(chosen), invalid=chosen.rows == "all")
    for draw in _GROUPS.values() if group is None else (_GROUPS[group],):
        for drawing in _explained(draw, rows):
            told = drawing if chosen.is_all else drawing.among_chosen()
            yield told.marked(prefix, note)


def _explained(draw: "Draw", rows: "_Rows") -> Iterator[Drawing]:
    """The drawings; an empty one says so where there are data, and only none that count."""
    everything: dict[str, Drawing] | None = None
    for drawing in draw(rows):
        if drawing.empty is not None and not rows.invalid and not rows.left.sessions.empty:
            if everything is None:
                everything = {one.key: one for one in draw(_Rows(rows.left, invalid=True))}
            other = everything.get(drawing.key)
            if other is not None and other.empty is None:
                yield replace(drawing, empty=f"{drawing.empty} {NONE_COUNTS}")
                continue
        yield drawing


class _Rows:
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

    def counting(self, table: pd.DataFrame) -> pd.DataFrame:
        """Of a table the rows that count."""
        return self.left.counting(table, invalid=self.invalid)


def _embodiment(rows: _Rows) -> Iterator[Drawing]:
    yield from embodiment_drawings(rows.counting(rows.left.scores))


def _answers(rows: _Rows) -> Iterator[Drawing]:
    yield from likert_drawings(rows.counting(rows.left.answers), rows.left.instruments)


def _tasks(rows: _Rows) -> Iterator[Drawing]:
    contacts = rows.counting(rows.left.contacts)
    yield completions_drawing(rows.phases)
    yield learning_drawing(rows.phases)
    yield contacts_drawing(rows.phases, contacts).of_group("tasks", wide=True)
    yield contact_map_drawing(rows.phases, contacts)


def _movement(rows: _Rows) -> Iterator[Drawing]:
    yield joint_error_body_drawing(rows.errors)
    yield joint_error_drawing(rows.errors).of_group("movement")
    yield achieved_drawing(rows.phases)
    yield joint_error_blocks_drawing(rows.errors)
    yield joint_error_course_drawing(rows.counting(rows.left.courses))
    yield joint_error_map_drawing(rows.errors).of_group("movement", wide=True)


def _quality(rows: _Rows) -> Iterator[Drawing]:
    left = rows.left
    yield quality_drawing(rows.counting(left.quality))
    yield exclusions_drawing(left.sessions, left.phases, left.scores)
    yield alarms_drawing(left.alarms, len(left.sessions))


def _progress(rows: _Rows) -> Iterator[Drawing]:
    left = rows.left
    yield progress_time_drawing(left.sessions, len(planned_slots(left.protocol))).of_group(
        "progress"
    )
    yield progress_drawing(left.sessions, _orders(left.protocol), blinded=left.blinded).of_group(
        "progress"
    )


Draw = Callable[[_Rows], Iterator[Drawing]]
_GROUPS: Mapping[FigureGroup, Draw] = {
    "embodiment": _embodiment,
    "answers": _answers,
    "tasks": _tasks,
    "movement": _movement,
    "quality": _quality,
    "progress": _progress,
}
"""What draws each group of the page."""


def _choices(material: Material) -> FilterChoices:
    sessions = material.sessions
    days = sessions["created_at_utc"].dt.date
    return FilterChoices(
        participants=sorted(set(sessions["participant_code"])),
        orders=_orders(material.protocol),
        limbs=sorted(material.limbs, reverse=True),
        first_day=None if sessions.empty else days.min(),
        last_day=None if sessions.empty else days.max(),
    )


def _orders(protocol: StudyProtocol) -> list[str]:
    latencies = {condition.key: condition.latency_ms for condition in protocol.conditions}
    slots = planned_slots(protocol)
    return sorted({" ".join(f"{latencies[name]:g}" for name in order) for order, _ in slots})


def _view(drawing: Drawing) -> FigureView:
    return FigureView(
        key=drawing.key,
        title=drawing.title,
        caption=drawing.caption,
        figure=drawing.as_json(),
        empty=drawing.empty,
        n=drawing.n,
        group=drawing.group,
        wide=drawing.wide,
    )
