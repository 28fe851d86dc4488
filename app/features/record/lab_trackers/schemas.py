"""Request and response models of the trackers that a session's headset uses."""

from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, StringConstraints, model_validator

from app.features.movement.live import DoorKey
from app.features.record.lab_trackers.link import Status
from app.science.alignment import Problem

Name = Annotated[str, StringConstraints(min_length=1, max_length=64)]


class TrackersWish(BaseModel):
    """The source whose trackers the headset shall use; both fields are null for none."""

    model_config = ConfigDict(extra="forbid")

    door: DoorKey | None
    source: Name | None

    @model_validator(mode="after")
    def _both_or_none(self) -> Self:
        if (self.door is None) != (self.source is None):
            raise ValueError("give both door and source, or null for both")
        return self


class SourceChoice(BaseModel):
    """A source that sends now; `limbs`: how many of its trackers are on a limb of the headset's."""

    door: DoorKey
    source: str
    is_silent: bool
    limbs: int
    has_reference: bool


class WornTracker(BaseModel):
    """A tracker on a limb. `used`: the headset gets this limb by it, or it is that on the head."""

    tracker: str
    limb: str
    used: bool
    tracked: bool
    silent_s: float | None


class DoubledLimb(BaseModel):
    """A limb on which several trackers send; the first of them is used."""

    limb: str
    trackers: list[str]


class LookedAround(BaseModel):
    """How far the wearer has looked around, in degrees; `progress` from 0 to 1 towards a fit."""

    turn_deg: float
    nod_deg: float
    progress: float = Field(ge=0.0, le=1.0)


class AlignmentView(BaseModel):
    """The alignment in force; lengths in millimetres, the last two over one minute of drift.

    `delay_ms`: how much later the trackers show a movement than the headset does. `residual_mm`,
    `residual_deg`: median difference of the head by both. `foot_mm`: standard error of a foot.
    `drift_mm_min`: how far the worlds drift apart in a minute. `fitted_s`: seconds since the fit.
    """

    delay_ms: float
    delay_uncertainty_ms: float
    residual_mm: float
    residual_p95_mm: float
    residual_deg: float
    foot_mm: float
    drift_mm_min: float
    outliers: float
    fitted_s: float


class SessionTrackers(BaseModel):
    """The trackers that a session's headset uses, and how they lie in its world.

    `status` is null if none are chosen. `others`: senders of the same name, which are not used.
    `doubled`: limbs with several trackers.
    `latency_ms`, `latency_p95_ms`: from a packet's arrival to the headset's socket, null before the
    first one. `stored`: poses on disk since the server started, `waiting_lost`: those that were
    given up because the disk was full for minutes. `refits`, `jumps`: since they were chosen.
    """

    door: DoorKey | None
    source: str | None
    choices: list[SourceChoice]
    status: Status | None
    problem: Problem | None = None
    looking: LookedAround | None = None
    alignment: AlignmentView | None = None
    trackers: list[WornTracker] = []
    others: list[str] = []
    doubled: list[DoubledLimb] = []
    latency_ms: float | None = None
    latency_p95_ms: float | None = None
    stored: int = 0
    waiting_lost: int = 0
    refits: int = 0
    jumps: int = 0
    state: Literal["planned", "active", "completed", "aborted", "withdrawn"]


class SessionBehindDoor(BaseModel):
    """A session that is not over and uses a source of a door: as its trackers, its companion."""

    session_id: str
    participant_code: str
    uses: list[Literal["trackers", "companion"]]
