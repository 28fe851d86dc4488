"""Request and response models of tunings, in SI units and degrees as their names say."""

from datetime import datetime
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, model_validator

from app.features.movement.avatar import MAX_VERSION, AvatarKey, AvatarTitle, Note
from app.protocol.avatar import AvatarFile

State = Literal["tuning", "stopped", "ready", "failed"]
Status = Literal["waiting", "measured", "tested", "tuned", "retried", "flagged", "locked", "kept"]
AxisName = Annotated[str, Field(min_length=1, max_length=40)]
Torque = Annotated[float, Field(gt=0.0, le=1e6, allow_inf_nan=False, description="N m")]
Accepted = Annotated[list[AxisName], Field(max_length=200)]


class AvatarNamed(BaseModel):
    """A stored version of an avatar; `version` is null for the newest."""

    model_config = ConfigDict(extra="forbid")

    key: AvatarKey
    version: Annotated[int | None, Field(ge=1, le=MAX_VERSION)] = None


class TuningChoice(BaseModel):
    """The options of a tuning, as for `reembody tune`; it uses no random numbers, so no seed.

    `axes`: those to tune, null for all that are free; with `mirror`, the left side is tuned and
    copied to the right. `relay_torque_nm`: one for all axes, and `relay_torques_nm` by axis; a ramp
    finds the others. An axis counts as not oscillating after `longest_s` of simulated time, or
    `longest_wall_s` by the clock.
    """

    model_config = ConfigDict(extra="forbid")

    axes: Annotated[list[AxisName] | None, Field(min_length=1, max_length=200)] = None
    heuristic: Literal["critical", "inertia", "ziegler-nichols-pd", "tyreus-luyben-pd"] = "critical"
    mirror: bool = False
    attempts: Annotated[int, Field(ge=1, le=10)] = 3
    accepted_overshoot_percent: Annotated[float, Field(ge=0, le=100, allow_inf_nan=False)] = 5.0
    longest_s: Annotated[float, Field(ge=0.01, le=600, allow_inf_nan=False)] = 10.0
    longest_wall_s: Annotated[float, Field(ge=0.001, le=600, allow_inf_nan=False)] = 20.0
    relay_torque_nm: Torque | None = None
    relay_torques_nm: Annotated[dict[AxisName, Torque], Field(max_length=200)] = {}


class NewTuning(BaseModel):
    """A body to tune: a stored `avatar`, or a `configuration` as in its file; exactly one."""

    model_config = ConfigDict(extra="forbid")

    avatar: AvatarNamed | None = None
    configuration: AvatarFile | None = None
    stature_m: Annotated[float, Field(ge=0.5, le=2.6, allow_inf_nan=False)] = 1.75
    options: TuningChoice = TuningChoice()

    @model_validator(mode="after")
    def _one_body(self) -> Self:
        if (self.avatar is None) == (self.configuration is None):
            raise ValueError("give either 'avatar' or 'configuration'")
        return self


class TuningProgressView(BaseModel):
    """The progress: `done` of `total` axes in the attempt's phase, most recently `axis`.

    `waiting`: it is queued behind another tuning, or its process is starting.
    """

    waiting: bool
    attempt: int
    phase: Literal["relay", "steps"]
    axis: str
    done: int
    total: int


class StepResponseView(BaseModel):
    """The figures of a step response on the whole body; a time is null if it was not reached."""

    step_deg: float
    overshoot_percent: float
    settling_s: float | None
    rise_s: float | None
    steady_error_deg: float


class RelayView(BaseModel):
    """A relay experiment: its torque and where that comes from, and the oscillation measured."""

    torque_nm: float
    torque_from: Literal["ramp", "chosen"]
    hysteresis_deg: float
    pose: Literal["straight", "bent"]
    amplitude_deg: float
    period_s: float
    ultimate_gain_nm_rad: float
    inertia_kg_m2: float
    simulated_s: float


class TunedAxis(BaseModel):
    """One axis of a tuning.

    `status`: `waiting`, `measured` and `tested` while it is tuned; then `tuned`, `retried` with a
    weaker relay, `flagged` with its `reason`, `locked`, or `kept` if it was not chosen. `kp` and
    `kd` (N m/rad, N m s/rad) are null until it is ready. `warning`: what a torque chosen by hand
    makes far worse than the ramp's.
    """

    name: str
    status: Status
    reason: str = ""
    note: str = ""
    warning: str = ""
    kp_before: float
    kd_before: float
    kp: float | None = None
    kd: float | None = None
    attempts: int = 0
    mirrored_from: str | None = None
    relay: RelayView | None = None
    step: StepResponseView | None = None


class TuningListed(BaseModel):
    """A tuning in a list; `avatar` is null if an unsaved configuration was tuned.

    `trouble`: why it failed, or what of it is damaged. `axes`: number of axes that are tuned; null
    if the configuration was damaged in the database, so that it cannot be read.
    """

    id: str
    state: State
    avatar: AvatarNamed | None
    content_hash: str
    stature_m: float
    axes: int | None
    progress: TuningProgressView | None
    trouble: str | None
    by: str
    at: datetime
    ended_at: datetime | None


class TuningView(BaseModel):
    """A tuning in full: its options and every axis, while it is tuned and afterwards.

    `report`: what is stored with a version of it; null until it is ready. `cpu_s`: its processor
    time since it was last resumed.
    """

    id: str
    state: State
    avatar: AvatarNamed | None
    content_hash: str
    stature_m: float
    options: TuningChoice
    progress: TuningProgressView | None
    tuned: list[TunedAxis]
    report: dict[str, Any] | None
    cpu_s: float | None
    trouble: str | None
    by: str
    at: datetime
    ended_at: datetime | None


class RelayCurveView(BaseModel):
    """The course of a relay experiment, from rest; the torque is the relay's."""

    time_s: list[float]
    angle_deg: list[float]
    torque_nm: list[float]
    hysteresis_deg: float


class StepCurveView(BaseModel):
    """The course of a step response on the whole body, and of the motor's torque.

    `saturated_share`: the share of the time in which the motor is at its torque limit.
    """

    time_s: list[float]
    angle_deg: list[float]
    torque_nm: list[float]
    target_deg: float
    saturated_share: float


class AxisCurvesView(BaseModel):
    """The curves of one axis: its relay experiment, and steps with the old and new gains.

    `relay` is null if there was no oscillation; a mirrored axis has that of the other side.
    """

    axis: str
    relay: RelayCurveView | None
    before: StepCurveView
    after: StepCurveView


class AcceptedAxes(BaseModel):
    """The axes whose new gains are accepted; all others keep their gains."""

    model_config = ConfigDict(extra="forbid")

    accepted: Accepted


class GainChangeView(BaseModel):
    """A gain that differs from before, by its key in a configuration file."""

    axis: str
    field: Literal["kp_nm_per_rad", "kd_nm_s_per_rad"]
    old: float
    new: float


class AcceptedConfiguration(BaseModel):
    """The tuned configuration with the accepted gains; nothing is stored."""

    configuration: AvatarFile
    content_hash: str
    changed: list[GainChangeView]


class ComparisonAsked(AcceptedAxes):
    """A capture on which to compare the gains before and after; null is a generated walk."""

    capture_id: Annotated[str | None, Field(max_length=32)] = None
    longest_s: Annotated[float, Field(ge=1.0, le=60.0, allow_inf_nan=False)] = 20.0


class SpreadView(BaseModel):
    """Mean and 95th percentile of absolute errors in degrees; null without samples."""

    mean_error_deg: float | None
    p95_error_deg: float | None
    samples: int


class FollowedView(BaseModel):
    """Errors of a body that follows a movement; see `docs/avatar.md`.

    `saturated`: axis -> share of the frames in which its motor is at its torque limit.
    """

    mean_error_deg: float
    p95_error_deg: float
    free: SpreadView
    touching: SpreadView
    unclamped: SpreadView
    clipped_share: float
    saturated: dict[str, float]
    touches: dict[str, float]
    frames: int


class FollowedBothView(FollowedView):
    """The errors in an empty space, and on a floor.

    `rms_error_deg` and `rms_torque_nm`: by driven axis, in the empty space.
    """

    on_floor: FollowedView
    rms_error_deg: dict[str, float]
    rms_torque_nm: dict[str, float]


class ComparisonView(BaseModel):
    """How the body follows a movement with the gains before and with the accepted ones."""

    frames: int
    duration_s: float
    before: FollowedBothView
    after: FollowedBothView


class TuningSaved(AcceptedAxes):
    """Where to save the accepted gains: a new key with a title, or the next version of a key.

    `based_on`: the version that was tuned, 0 for a new key; another version is refused, because its
    own settings would be lost. At least one axis must be accepted.
    """

    key: AvatarKey
    title: AvatarTitle | None = None
    based_on: Annotated[int, Field(ge=0, le=MAX_VERSION)] = 0
    note: Note = ""
