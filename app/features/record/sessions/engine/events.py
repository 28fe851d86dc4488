"""The events of a session: facts that are appended, hashed and never edited.

Payloads contain no answers, notes or personal text. An event that needs a text refers to content by
id, with a salted hash: an erasure removes content and salt, and the chain still verifies.
"""

from dataclasses import asdict, dataclass
from typing import Any, ClassVar

from pydantic import TypeAdapter


@dataclass(frozen=True, kw_only=True)
class Event:
    """The base class of all events; `type` is the stored name."""

    type: ClassVar[str]


@dataclass(frozen=True, kw_only=True)
class SessionStarted(Event):
    """The operator started the session, which freezes the study version."""

    type = "session_started"


@dataclass(frozen=True, kw_only=True)
class StepCompleted(Event):
    """A step without a clock was completed by the operator, the tablet or the headset."""

    type = "step_completed"
    step: int
    by: str
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class FormSubmitted(Event):
    """A form was submitted and stored."""

    type = "form_submitted"
    step: int
    submission_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class AvatarMaterialised(Event):
    """The avatar appeared; from here on movement is recorded."""

    type = "avatar_materialised"
    step: int
    by: str
    client_t_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class StepSkipped(Event):
    """The operator skipped a step, for a recorded reason."""

    type = "step_skipped"
    step: int
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class StepReopened(Event):
    """The operator went back to repeat a step; later steps are reopened, too."""

    type = "step_reopened"
    step: int
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class PhasePrepared(Event):
    """A timed phase was prepared; the headset counts down its preparation time.

    `body`: the body that the condition prescribes; None for that of the avatar's configuration.
    """

    type = "phase_prepared"
    step: int
    phase_id: int
    attempt: int
    latency_ms: float
    body: str | None = None


@dataclass(frozen=True, kw_only=True)
class PhaseStarted(Event):
    """The headset started the phase's clock."""

    type = "phase_started"
    phase_id: int
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class PauseRequested(Event):
    """The operator requested a pause, or a refusal did."""

    type = "pause_requested"
    phase_id: int
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class PhasePaused(Event):
    """The phase's clock was paused. `cause`: operator, headset_lost, server_restarted or headset.

    If the headset could not be reached, `client_t_s` is null and `active_s` is the last stored
    value; the headset's own report follows when it reconnects.
    """

    type = "phase_paused"
    phase_id: int
    active_s: float
    cause: str
    client_t_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class ResumeRequested(Event):
    """The operator requested that the phase continues."""

    type = "resume_requested"
    phase_id: int


@dataclass(frozen=True, kw_only=True)
class PhaseResumed(Event):
    """The phase's clock was resumed."""

    type = "phase_resumed"
    phase_id: int
    active_s: float
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class WalkBackStarted(Event):
    """A foot task was completed: the clock is stopped while the participant walks back."""

    type = "walk_back_started"
    phase_id: int
    active_s: float
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class WalkBackEnded(Event):
    """The participant reached the start square: the clock was resumed."""

    type = "walk_back_ended"
    phase_id: int
    active_s: float
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class PhaseFrozen(Event):
    """The phase's active time is over: scene and avatar freeze."""

    type = "phase_frozen"
    phase_id: int
    active_s: float
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class PhaseEnded(Event):
    """The freeze ended, and with it the phase; unless it is voided later, the phase counts."""

    type = "phase_ended"
    phase_id: int
    active_s: float
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class PhaseVoided(Event):
    """The phase no longer counts (redo, skip, abort, withdraw); its data are retained.

    `active_s`: how far it was if it was interrupted; null if it had ended, and in older records.
    """

    type = "phase_voided"
    phase_id: int
    cause: str
    active_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class SessionEnded(Event):
    """The session ended: it was completed, aborted or withdrawn."""

    type = "session_ended"
    status: str
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class BlindingLifted(Event):
    """The session's condition was deliberately shown to a person, for a recorded reason."""

    type = "blinding_lifted"
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class NoteAdded(Event):
    """The operator wrote a note."""

    type = "note_added"
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class AvatarBuilt(Event):
    """The headset uses a physics avatar, identified by the hash of its configuration.

    The content contains the stature it was built for and the model itself. `body`: the body it has,
    by name; None for that of the configuration.
    """

    type = "avatar_built"
    configuration_hash: str
    content_id: str
    content_hash: str
    body: str | None = None


@dataclass(frozen=True, kw_only=True)
class AvatarChanged(Event):
    """The settings of the running avatar were changed, by the `operator` or by the `study`.

    `changes`: the content of an `AvatarChanges`. Those of the operator hold until the next such
    event; if empty, they were taken back. Those of the study hold until the phase ends.
    `deviation`: the operator made the change while a phase was in progress.
    """

    type = "avatar_changed"
    by: str
    changes: dict[str, Any]
    phase_id: int | None = None
    deviation: bool = False
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class AvatarChangeReported(Event):
    """The headset reported that changes took effect on the avatar, or that it could not apply them.

    `revision`: the `seq` of the event since which they are in force. The content has the angles of
    casts, which reveal how the participant stood, or the headset's reason.
    """

    type = "avatar_change_reported"
    revision: int
    applied: bool
    client_t_s: float
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class CalibrationRequested(Event):
    """The operator asked for a new calibration of the participant's body, in whatever step."""

    type = "calibration_requested"
    phase_id: int | None = None
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class TrackerShifted(Event):
    """The operator shifted the joint of a goal from where its tracker says, by `shift_m` in all.

    x to the right, y up, z backwards, in the axes that the part has in the T-pose. It holds until
    the next such event of the goal, or the next calibration. `deviation`: a phase was in progress.
    """

    type = "tracker_shifted"
    goal: str
    shift_m: tuple[float, float, float]
    phase_id: int | None = None
    deviation: bool = False
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class CalibrationReported(Event):
    """The headset calibrated itself to the participant's body, and uses the result from now on.

    `revision`: the `seq` of the event that asked for it; None if the headset did so by itself, and
    `cause` says why. The content has what was measured, which describes the participant.
    """

    type = "calibration_reported"
    cause: str
    client_t_s: float
    content_id: str
    content_hash: str
    revision: int | None = None


@dataclass(frozen=True, kw_only=True)
class TrackersChosen(Event):
    """Somebody chose the lab's trackers that the headset uses; both fields are None for none.

    `door` and `source` name them as the page of trackers does. `deviation`: a phase was in
    progress.
    """

    type = "trackers_chosen"
    door: str | None
    source: str | None
    phase_id: int | None = None
    deviation: bool = False


@dataclass(frozen=True)
class Companion:
    """A performer who is shown to the participant as another person in the virtual room.

    Attributes:
        door, source, skeleton: the performer, as the page of trackers names them.
        stature: of the body that is shown, such as "165cm".
        humanoid: content hash of the body's model; None for a plain body of capsules.
        place: where they stand, such as "ahead_left".
        position_m: x and z of that place, in the participant's room.
        heading_rad: where they face, about the vertical axis: 0 towards -z, positive to the left.
        in_tasks: whether they are also seen while the participant does a task at the boxes.
    """

    door: str
    source: str
    skeleton: str
    stature: str
    humanoid: str | None
    place: str
    position_m: tuple[float, float]
    heading_rad: float
    in_tasks: bool = False


@dataclass(frozen=True, kw_only=True)
class CompanionChosen(Event):
    """Somebody chose a performer whom the participant sees as another person; None for nobody.

    `deviation`: a phase was in progress.
    """

    type = "companion_chosen"
    companion: Companion | None
    phase_id: int | None = None
    deviation: bool = False


@dataclass(frozen=True, kw_only=True)
class TrackersAligned(Event):
    """How the trackers lie in the headset's world has become known, or no longer holds.

    `change`: `first` and `recentred` bring an alignment, `lost` (the headset's world jumped) and
    `moved` (the tracker on the head did) end it. All of its figures are stored under
    `alignment_id`. `delay_s`, `residual_m` (median) and `uncertainty_m` (of a foot) are those of
    the alignment that is known, `offset_m` and `offset_rad` the size of the jump.
    """

    type = "trackers_aligned"
    change: str
    alignment_id: str
    client_t_s: float
    delay_s: float | None = None
    residual_m: float | None = None
    uncertainty_m: float | None = None
    offset_m: float | None = None
    offset_rad: float | None = None


@dataclass(frozen=True, kw_only=True)
class StopAsked(Event):
    """The participant wants to stop, and said so inside the headset; a running phase is paused."""

    type = "stop_asked"
    client_t_s: float
    step: int | None = None
    phase_id: int | None = None


@dataclass(frozen=True, kw_only=True)
class StopClosed(Event):
    """The wish to stop was `answered` by the experimenter, or `taken_back` by the participant."""

    type = "stop_closed"
    outcome: str


@dataclass(frozen=True, kw_only=True)
class CheckOverridden(Event):
    """Somebody proceeded although the pre-flight check `check` was not green.

    The content contains the reason, and what the check had found.
    """

    type = "check_overridden"
    check: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class FormRefused(Event):
    """Different answers arrived for a stored form: they were rejected, and stored separately."""

    type = "form_refused"
    submission_id: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class AnswersCorrected(Event):
    """A stored answer was corrected: the original is retained, the latest correction applies."""

    type = "answers_corrected"
    submission_id: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class DataErased(Event):
    """The participant's data were erased; `erasure_id` is the id of the tombstone.

    `reason_code`: withdrawn, requested, retention or mistake.
    """

    type = "data_erased"
    erasure_id: str
    reason_code: str


@dataclass(frozen=True, kw_only=True)
class StopRuleMet(Event):
    """A form met the study's stop rule with the index `rule`, so the session is held."""

    type = "stop_rule_met"
    rule: int
    submission_id: str


@dataclass(frozen=True, kw_only=True)
class StopRuleOverridden(Event):
    """The operator continued although a stop rule was met, for a recorded reason."""

    type = "stop_rule_overridden"
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class ConsentRefused(Event):
    """The participant refused to take part, so the session is held."""

    type = "consent_refused"
    step: int
    by: str


@dataclass(frozen=True, kw_only=True)
class RefusalRetracted(Event):
    """The participant took the refusal back, so the consent is shown again; nothing is agreed yet.

    It comes from the tablet or the operator, whose reason is stored as content.
    """

    type = "refusal_retracted"
    step: int
    by: str
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class QuestionAsked(Event):
    """The participant has a question about a step's text; `step` is null before the start."""

    type = "question_asked"
    step: int | None = None


@dataclass(frozen=True, kw_only=True)
class QuestionClosed(Event):
    """The question was closed. `outcome`: answered by the experimenter, or taken_back."""

    type = "question_closed"
    outcome: str


EVENT_TYPES: dict[str, type[Event]] = {
    cls.type: cls
    for cls in (
        SessionStarted,
        StepCompleted,
        FormSubmitted,
        StopRuleMet,
        StopRuleOverridden,
        ConsentRefused,
        RefusalRetracted,
        QuestionAsked,
        QuestionClosed,
        AvatarMaterialised,
        StepSkipped,
        StepReopened,
        PhasePrepared,
        PhaseStarted,
        PauseRequested,
        PhasePaused,
        ResumeRequested,
        PhaseResumed,
        WalkBackStarted,
        WalkBackEnded,
        PhaseFrozen,
        PhaseEnded,
        PhaseVoided,
        AvatarBuilt,
        AvatarChanged,
        AvatarChangeReported,
        CalibrationRequested,
        TrackerShifted,
        CalibrationReported,
        TrackersChosen,
        TrackersAligned,
        CompanionChosen,
        StopAsked,
        StopClosed,
        BlindingLifted,
        CheckOverridden,
        NoteAdded,
        FormRefused,
        AnswersCorrected,
        DataErased,
        SessionEnded,
    )
}
_ADAPTERS = {name: TypeAdapter(cls) for name, cls in EVENT_TYPES.items()}


def event_to_json(event: Event) -> dict[str, Any]:
    """Return the payload of an event; its type is stored separately."""
    payload = asdict(event)
    # Left out if not set, so that the logs of studies without bodies stay as they were.
    if payload.get("body") is None:
        payload.pop("body", None)
    return payload


def event_from_json(event_type: str, payload: dict[str, Any]) -> Event:
    """Rebuild a stored event; raises KeyError for a type that this version does not define."""
    return _ADAPTERS[event_type].validate_python(payload)
