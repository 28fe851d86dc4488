"""Response models of the study's road in a session."""

from datetime import datetime

from pydantic import BaseModel


class CrossingView(BaseModel):
    """How the participant crossed once, see `RoadCrossing`; times are the phase's active time."""

    phase_id: int
    number: int
    steps_on_s: float | None
    steps_off_s: float | None
    is_across: bool
    waited_s: float
    gap_accepted_s: float | None
    gaps_refused_s: list[float]
    least_time_to_collision_s: float | None
    least_post_encroachment_s: float | None
    closest_m: float | None
    collision_car: str | None
    collision_s: float | None
    collision_speed_m_s: float | None


class RoadRunView(BaseModel):
    """One run of the road during a phase, see `RoadRun`."""

    id: str
    phase_id: int
    part: int
    seed: int
    begins_at_s: float
    began_at: datetime
    ended_at: datetime | None
    ended: str
    reason: str
    steps: int
    guesses: int
    worst_guess_m: float | None
    sha256: str | None
    crossings: list[CrossingView]


class RoadNow(BaseModel):
    """How the newest scene goes.

    `waits_for`: programs that have not connected yet, with their addresses. `problem`: why it broke
    off, empty if it did not.
    """

    phase_id: int
    steps: int
    guesses: int
    cars: int
    is_heard: bool
    waits_for: list[str]
    is_over: bool
    problem: str


class SessionRoad(BaseModel):
    """The road of a session; `missing` says what its study needs that is not installed."""

    has_road: bool
    missing: str
    now: RoadNow | None
    runs: list[RoadRunView]
