"""Response models of a phase's replay; its movement is sent separately as bytes (`movement`).

Two times identify a moment of a phase, and a third one gives the time of day:

- `t_s`, the phase's time: seconds of the headset's clock since the phase's clock first ran. It
  continues through pauses and lost connections, so that records are at the time they happened.
- `active_s`, the active time: the time that counts. It stops in pauses and on the way back.
- UTC, by the server's clock: `runs` map the phase's time to it.
"""

from datetime import datetime
from typing import Literal

from pydantic import BaseModel

from app.features.record.cockpit import LimbName, PhaseStatus
from app.features.record.questionnaires import StoredScores
from app.protocol import StepKind
from app.wire import PhaseEvent

View = Literal["full", "participant"]
"""What a replay shows; `participant`, for blinded readers: only the participant's own movement.

The avatar and its contacts are left out, because their delay would reveal the latency."""
What = Literal[PhaseEvent, "voided"]
Vector = tuple[float, float, float]


class ActiveStretch(BaseModel):
    """A span in which the phase's clock ran, in the phase's time and in active time."""

    begin_s: float
    end_s: float
    begin_active_s: float
    end_active_s: float


class ClientRun(BaseModel):
    """One run of the headset's program, from its first to its last moment in the phase.

    `begin_utc`: its start by the server's clock; null where it is unknown. `uncertainty_ms`: that
    of `begin_utc`; null if there is no clock probe and `begin_utc` is the arrival of a message.
    """

    epoch: int
    begin_s: float
    end_s: float
    begin_utc: datetime | None
    uncertainty_ms: float | None


class ReplayContact(BaseModel):
    """The contact of a body part of the avatar with a surface; `effect`: its effect in the task."""

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
    """A completed task in the replay of a phase."""

    number: int
    t_s: float
    active_s: float
    duration_s: float
    out_of_order_touches: int


class Moment(BaseModel):
    """A change of the phase's clock, and its cause."""

    what: What
    t_s: float
    active_s: float
    cause: str | None


class ReplayNote(BaseModel):
    """A note that the lab wrote during the phase."""

    id: str
    text: str
    by: str
    at: datetime
    t_s: float


class ReplaySurface(BaseModel):
    """A surface of the task's scene: its centre and half its size in metres, in world coordinates.

    `kind`: panel, side, target or start. `box` is null for target and start.
    """

    key: str
    kind: str
    box: int | None
    center_m: Vector
    half_size_m: Vector


class ReplayAvatarSettings(BaseModel):
    """From `t_s` on: parts of the avatar that were in a cast, and parts without a collider."""

    t_s: float
    held_parts: list[str]
    passing_parts: list[str]


class Replay(BaseModel):
    """One phase; a `participant` view has no latency, contacts, completions and scene.

    `forms`: scores of the forms filled in after this phase and before the next, in order;
    `administrations` names all of them, with or without scores. `stature_m` is that of the body
    drawn; if it is unknown, a default is used. `humanoid`: hash of the model that the avatar wore,
    null for none and for blinded readers, to whom it could reveal the condition. `time_scale`:
    seconds of the headset's clock per second of the server's.
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
    body: str | None
    duration_s: float
    active_s: float
    time_scale: float
    stature_m: float
    stature_known: bool
    humanoid: str | None = None
    avatar_settings: list[ReplayAvatarSettings] = []
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
