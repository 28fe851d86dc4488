"""A dashboard with its filter, the study's tests and a codebook as they travel to a page."""

from datetime import date, datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

Rows = Literal["valid", "all"]
LimbChoice = Literal["hand", "foot"]
Code = Annotated[str, StringConstraints(min_length=1, max_length=80)]
MOST_PARTICIPANTS = 200
_SHOWN = 6
Kind = Literal["people", "simulated", "test", "all"]
DashboardKind = Literal["people", "simulated", "test"]
FigureGroup = Literal["progress", "embodiment", "answers", "tasks", "movement", "quality"]


class FigureFilter(BaseModel):
    """Which sessions and rows are drawn; everything unless named.

    `rows`: "valid" leaves out what does not count (sessions that were broken off or are not valid
    by the study's rules, superseded and skipped steps), "all" draws it too. `since` and `until`:
    days, both included, on which a session was created, in UTC. `order`: added latencies in ms in
    the order of the blocks, as in "0 125 350".
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    participant: Annotated[tuple[Code, ...], Field(max_length=MOST_PARTICIPANTS)] = ()
    order: Annotated[str | None, Field(max_length=80)] = None
    rows: Rows = "valid"
    since: date | None = None
    until: date | None = None
    limb: LimbChoice | None = None

    @property
    def is_all(self) -> bool:
        """Whether nothing was chosen."""
        return self == FigureFilter()

    def words(self) -> str:
        """What was chosen, as the sentence that stands in captions and files; empty for nothing."""
        told = [*self._of_whom(), *self._when()]
        if self.limb is not None:
            told.append(f"the {self.limb} task")
        chosen = f"Only {', '.join(told)}." if told else ""
        everything = (
            "Rows that do not count are drawn too (broken off, not valid, superseded, skipped)."
        )
        return f"{chosen} {everything if self.rows == 'all' else ''}".strip()

    def _of_whom(self) -> list[str]:
        told = []
        if self.participant:
            shown = ", ".join(self.participant[:_SHOWN])
            more = len(self.participant) - _SHOWN
            told.append(f"participants {shown}{f' and {more} more' if more > 0 else ''}")
        if self.order is not None:
            told.append(f"order {self.order.replace(' ', ' → ')} ms")
        return told

    def _when(self) -> list[str]:
        if self.since is not None and self.until is not None:
            return [f"sessions from {self.since} to {self.until} (UTC)"]
        if self.since is not None:
            return [f"sessions since {self.since} (UTC)"]
        return [f"sessions until {self.until} (UTC)"] if self.until is not None else []


NO_FILTER = FigureFilter()


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
    """The figures of a study's sessions of one kind, as far as a filter leaves them.

    `n_not_valid` of the `n_completed` sessions do not count by the study's rules.
    """

    kind: str
    simulated: bool
    n_sessions: int
    n_completed: int
    n_not_valid: int
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
    n_not_valid: int
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
