"""Response and query models of the dashboard, the study's tests and the codebook."""

from datetime import date, datetime
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

Rows = Literal["valid", "all"]
LimbChoice = Literal["hand", "foot"]
Code = Annotated[str, StringConstraints(min_length=1, max_length=80)]
MAX_PARTICIPANTS = 200
_SHOWN = 6
Kind = Literal["people", "simulated", "test", "all"]
DashboardKind = Literal["people", "simulated", "test"]
FigureGroup = Literal[
    "progress", "embodiment", "answers", "tasks", "movement", "demographics", "quality"
]


class FigureFilter(BaseModel):
    """The selection of sessions and rows to draw; by default, all valid rows of all sessions.

    `rows`: "valid" leaves out what does not count (sessions that were broken off or are not valid
    by the study's rules, superseded and skipped steps), "all" draws it too. `since` and `until`:
    the first and last day, in UTC, on which a session was created. `order`: added latencies in ms
    in the order of the blocks, as in "0 125 350". `body`: only phases in which this body was worn;
    if it is left out in a study whose conditions share latencies, the first body is chosen,
    because figures are drawn over latency.
    """

    model_config = ConfigDict(frozen=True, extra="forbid")

    participant: Annotated[tuple[Code, ...], Field(max_length=MAX_PARTICIPANTS)] = ()
    order: Annotated[str | None, Field(max_length=80)] = None
    rows: Rows = "valid"
    since: date | None = None
    until: date | None = None
    limb: LimbChoice | None = None
    body: Annotated[str | None, Field(max_length=80)] = None

    @property
    def is_all(self) -> bool:
        """Return whether the filter has its default values."""
        return self == FigureFilter()

    def words(self) -> str:
        """Return the filter as a sentence for captions and files, empty for the default filter."""
        parts = [*self._participant_parts(), *self._period_parts()]
        if self.limb is not None:
            parts.append(f"the {self.limb} task")
        if self.body is not None:
            parts.append(f"the body {self.body}")
        chosen = f"Only {', '.join(parts)}." if parts else ""
        everything = "Invalid rows are included, too (broken off, not valid, superseded, skipped)."
        return f"{chosen} {everything if self.rows == 'all' else ''}".strip()

    def _participant_parts(self) -> list[str]:
        parts = []
        if self.participant:
            shown = ", ".join(self.participant[:_SHOWN])
            more = len(self.participant) - _SHOWN
            parts.append(f"participants {shown}{f' and {more} more' if more > 0 else ''}")
        if self.order is not None:
            unit = " ms" if self.order.replace(" ", "").replace(".", "").isdigit() else ""
            parts.append(f"order {self.order.replace(' ', ' → ')}{unit}")
        return parts

    def _period_parts(self) -> list[str]:
        if self.since is not None and self.until is not None:
            return [f"sessions from {self.since} to {self.until} (UTC)"]
        if self.since is not None:
            return [f"sessions since {self.since} (UTC)"]
        return [f"sessions until {self.until} (UTC)"] if self.until is not None else []


NO_FILTER = FigureFilter()


class DashboardQuery(FigureFilter):
    """The query of a dashboard: the kind of sessions and a filter."""

    kind: DashboardKind = "people"

    @property
    def filter(self) -> FigureFilter:
        """Return the filter without the kind."""
        return FigureFilter(**self.model_dump(include=set(FigureFilter.model_fields)))


class GroupQuery(DashboardQuery):
    """The query of a dashboard, or of one group of its figures (`group`)."""

    group: FigureGroup | None = None


class FigureView(BaseModel):
    """A figure for plotly.js, or a sentence (`empty`) that says what is missing; `n` participants.

    `wide`: the figure needs the full width of the page. `measure`: the measure of the statistics
    that has the tests of what is drawn; null if there are none.
    """

    key: str
    title: str
    caption: str
    figure: dict[str, Any] | None
    empty: str | None
    n: int
    group: FigureGroup
    wide: bool
    measure: str | None


class FilterChoices(BaseModel):
    """The values that the filter can take.

    They are participant codes, orders as "0 125 350", limbs, bodies, and the first and last day in
    UTC. Bodies are listed only if conditions share latencies and differ in their bodies.
    """

    participants: list[str]
    orders: list[str]
    limbs: list[str]
    bodies: list[str]
    first_day: date | None
    last_day: date | None


class DashboardFigures(BaseModel):
    """The figures of a study's sessions of one kind that pass a filter.

    `n_not_valid` of the `n_completed` sessions are not valid by the study's rules. `n_running`
    sessions are still running, and what they have so far is drawn, too; 0 in a blinded study.
    """

    kind: str
    simulated: bool
    n_sessions: int
    n_completed: int
    n_not_valid: int
    n_running: int
    avatar: list[str]
    filter: FigureFilter
    choices: FilterChoices
    figures: list[FigureView]


class DashboardView(DashboardFigures):
    """Figures as drawn at `drawn_at`; if not `current`, newer data are being drawn."""

    drawn_at: datetime
    current: bool


class ResultView(BaseModel):
    """The report of one test: a sentence for readers, a table for reviewers, a line for a paper.

    `exploratory`: the test was not preregistered. `warnings`: reasons for caution.
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
    """The results of one limb in brief, each null if it could not be tested.

    `factor`: what was compared. `differ`: whether the latencies, or bodies, differ at all. `first`:
    the first latency that differs from the smallest one, or the pairs of bodies that differ (of two
    bodies, their p); empty if none does. `trend`: of the trend along latency, one-sided where a
    direction was predicted; bodies have none. `way`: the direction of the trend.
    """

    limb: str
    factor: Literal["latency", "body"] = "latency"
    differ: str | None
    first: str | None
    trend: str | None
    way: Literal["rises", "falls"] | None


class EffectView(BaseModel):
    """The difference between the ends of the factor in one limb, in the measure's unit.

    `low`, `high`: Student's 95 % interval of the mean difference; null if they are equal.
    `standardised`: Cohen's d_av with the interval on the same scale; null where nothing varies.
    """

    limb: str
    contrast: str
    n: int
    difference: float
    low: float | None
    high: float | None
    standardised: float | None
    standardised_low: float | None
    standardised_high: float | None


class MeasureView(BaseModel):
    """The test results of one measure; `left_out` says which participants are left out, and why.

    `glance` has a row for each limb whose latencies were compared, and so has `effects`.
    """

    key: str
    title: str
    unit: str
    about: str
    n: int
    left_out: list[str]
    glance: list[GlanceView]
    effects: list[EffectView]
    results: list[ResultView]


class StatisticsResults(BaseModel):
    """The test results of a study's sessions of one kind.

    `alpha`: the level that p is compared with. `declared`: whether the study preregistered it.
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
    """Test results as computed at `drawn_at`; if not `current`, newer ones are being computed."""

    drawn_at: datetime
    current: bool


class ColumnView(BaseModel):
    """The codebook entry of one exported column."""

    table: str
    column: str
    meaning: str
    unit: str
    type: str
    levels: str
