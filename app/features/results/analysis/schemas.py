"""A dashboard, the study's tests and a codebook as they travel to a page."""

from datetime import date, datetime
from typing import Any, Literal

from pydantic import BaseModel

from app.features.results.analysis.filters import FigureFilter

Kind = Literal["people", "simulated", "test", "all"]
DashboardKind = Literal["people", "simulated", "test"]
FigureGroup = Literal["progress", "embodiment", "answers", "tasks", "movement", "quality"]


class DashboardAsked(FigureFilter):
    """What a page asks for: whose sessions, and which of them."""

    kind: DashboardKind = "people"

    @property
    def filter(self) -> FigureFilter:
        """Without the kind."""
        return FigureFilter(**self.model_dump(include=set(FigureFilter.model_fields)))


class GroupAsked(DashboardAsked):
    """The same with the group whose figures are wanted; all of them unless named."""

    group: FigureGroup | None = None


class FigureView(BaseModel):
    """A figure for plotly.js, or in plain words what is missing for it; `n` participants.

    `wide`: it needs the width of the page.
    """

    key: str
    title: str
    caption: str
    figure: dict[str, Any] | None
    empty: str | None
    n: int
    group: FigureGroup
    wide: bool


class FilterChoices(BaseModel):
    """What can be chosen from: codes, orders as "0 125 350", limbs, first and last day (UTC)."""

    participants: list[str]
    orders: list[str]
    limbs: list[str]
    first_day: date | None
    last_day: date | None


class DashboardFigures(BaseModel):
    """The figures of a study's sessions of one kind, as far as a filter leaves them."""

    kind: str
    simulated: bool
    n_sessions: int
    n_completed: int
    avatar: list[str]
    filter: FigureFilter
    choices: FilterChoices
    figures: list[FigureView]


class DashboardView(DashboardFigures):
    """Figures as they were drawn at `drawn_at`; not `current`: newer data are being drawn."""

    drawn_at: datetime
    current: bool


class ResultView(BaseModel):
    """One answer: a sentence for a reader, a table for a reviewer, a line for a paper.

    `exploratory`: looked at, not declared. `warnings`: what speaks against relying on it.
    """

    key: str
    title: str
    sentence: str
    apa: str
    columns: list[str]
    rows: list[list[str]]
    method: str
    source: str
    warnings: list[str]
    exploratory: bool


class GlanceView(BaseModel):
    """The answers of one limb in a few signs each; null where it could not be tested.

    `differ`: whether the latencies differ at all. `first`: the first latency that differs from the
    smallest one, empty where none does. `trend` along latency, one-sided where one was
    predicted, and the `way` that the measure goes.
    """

    limb: str
    differ: str | None
    first: str | None
    trend: str | None
    way: Literal["rises", "falls"] | None


class MeasureView(BaseModel):
    """What was asked of one measure; `left_out` says in words who is not in it, and why.

    `glance` has a row for each limb whose latencies were compared.
    """

    key: str
    title: str
    unit: str
    about: str
    n: int
    left_out: list[str]
    glance: list[GlanceView]
    results: list[ResultView]


class StatisticsResults(BaseModel):
    """The study's questions, answered from its sessions of one kind.

    `alpha`: what p is compared with. `declared`: whether the study declared it before.
    """

    kind: str
    simulated: bool
    n_sessions: int
    n_completed: int
    alpha: float
    declared: bool
    notes: list[str]
    measures: list[MeasureView]


class StatisticsView(StatisticsResults):
    """Answers as of `drawn_at`; not `current`: they are being computed anew."""

    drawn_at: datetime
    current: bool


class ColumnView(BaseModel):
    """A column of an export."""

    table: str
    column: str
    meaning: str
    unit: str
    type: str
    levels: str
