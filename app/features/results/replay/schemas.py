"""A phase's replay as a page gets it; its movement comes beside it as bytes (`movement`).

Two times name a moment of a phase, and a third one the hour:

- `t_s`, the phase's time: seconds of the headset's clock since the phase's clock first ran. It goes
  on through pauses and losses of the headset, so that what was recorded lies on it as it happened.
- `active_s`, the active time: what counted. It stands in pauses and on the way back.
- UTC, by the server's clock: `runs` lead from the phase's time to it.
"""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from app.features.record.cockpit import LimbName, PhaseStatus
from app.features.record.questionnaires import StoredScores
from app.protocol import StepKind
from app.wire.messages import PhaseEvent

View = Literal["full", "participant"]
"""`participant`: for readers who must not learn the latency. The participant's own movement alone,
without the avatar and without what happened to it: their distance in time is the latency."""
What = Literal[PhaseEvent, "voided"]
Vector = tuple[float, float, float]


class ActiveStretch(BaseModel):
    """A stretch in which the phase's clock ran, on both of its times."""

    begin_s: float
    end_s: float
    begin_active_s: float
    end_active_s: float


class ClientRun(BaseModel):
    """One run of the headset's program in the phase, from its first to its last moment here.

    `begin_utc`: when it began, by the server's clock; null where that cannot be said.
    `uncertainty_ms`: how well; null where no clock was compared and it is when the message came.
    """

    epoch: int
    begin_s: float
    end_s: float
    begin_utc: datetime | None
    uncertainty_ms: float | None


class ReplayContact(BaseModel):
    """One part of the avatar at one surface; `effect` is what the task made of it."""

    surface: str
    surface_kind: str
    box: int | None
    body_part: str
    effect: str
    begin_s: float
    end_s: float
    begin_active_s: float
    end_active_s: float


class ReplayCompletion(BaseModel):
    """A completed task."""

    number: int
    t_s: float
    active_s: float
    duration_s: float
    out_of_order_touches: int


class Moment(BaseModel):
    """Something that the phase's clock did, and why."""

    what: What
    t_s: float
    active_s: float
    cause: str | None


class ReplayNote(BaseModel):
    """A note of the lab that was written during the phase."""

    id: str
    text: str
    by: str
    at: datetime
    t_s: float


class ReplaySurface(BaseModel):
    """A block of the task's scene: its centre and half its size, metres, in the movement's world.

    `kind`: panel, side, target or start. `box` is null for target and start.
    """

    key: str
    kind: str
    box: int | None
    center_m: Vector
    half_size_m: Vector


class Replay(BaseModel):
    """One phase. Latency, contacts, completions and scene are left out of a `participant` view.

    `forms`: scores of the forms filled in after this phase and before the next, in order;
    `administrations` names all of them, with or without scores. `stature_m` is the body's that is
    drawn; where it is not known, a usual one is taken. `time_scale`: seconds of the headset's clock
    per second of the server's.
    """

    session_id: str
    phase_id: int
    step_index: int
    attempt: int
    kind: StepKind
    limb: LimbName | None
    status: PhaseStatus
    view: View
    latency_ms: float | None
    duration_s: float
    active_s: float
    time_scale: float
    stature_m: float
    stature_known: bool
    has_movement: bool
    runs: list[ClientRun]
    active: list[ActiveStretch]
    contacts: list[ReplayContact]
    completions: list[ReplayCompletion]
    moments: list[Moment]
    notes: list[ReplayNote]
    surfaces: list[ReplaySurface]
    administrations: list[str]
    forms: list[StoredScores]
