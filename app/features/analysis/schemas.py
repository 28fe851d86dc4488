"""A dashboard and a codebook as they travel to a page."""

from datetime import datetime
from typing import Any, Literal

from pydantic import BaseModel

Kind = Literal["people", "simulated", "test", "all"]
DashboardKind = Literal["people", "simulated", "test"]


class FigureView(BaseModel):
    """A figure for plotly.js, or in plain words what is missing for it; `n` participants."""

    key: str
    title: str
    caption: str
    figure: dict[str, Any] | None
    empty: str | None
    n: int


class DashboardFigures(BaseModel):
    """The figures of a study's sessions of one kind."""

    kind: str
    simulated: bool
    n_sessions: int
    n_completed: int
    avatar: list[str]
    figures: list[FigureView]


class DashboardView(DashboardFigures):
    """Figures as they were drawn at `drawn_at`; not `current`: newer data are being drawn."""

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
