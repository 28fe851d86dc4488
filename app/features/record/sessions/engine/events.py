"""What can have happened. Events are facts: appended, hashed, never edited.

Payloads hold no answers, notes or personal text. Where an event needs words it points at content
by id, with a salted hash: erasure removes content and salt, and the chain still verifies.
"""

from dataclasses import asdict, dataclass
from typing import Any, ClassVar

from pydantic import TypeAdapter


@dataclass(frozen=True, kw_only=True)
class Event:
    """Base of all events; `type` is its stored name."""

    type: ClassVar[str]


@dataclass(frozen=True, kw_only=True)
class SessionStarted(Event):
    """The operator started the session; the study version is frozen from here."""

    type = "session_started"


@dataclass(frozen=True, kw_only=True)
class StepCompleted(Event):
    """A step without a clock is done, by the operator, the tablet or the headset."""

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
    """The remote avatar exists from here: recording starts."""

    type = "avatar_materialised"
    step: int
    by: str
    client_t_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class StepSkipped(Event):
    """The operator skipped a step and said why."""

    type = "step_skipped"
    step: int
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class StepReopened(Event):
    """The operator goes back to a step to do it over; later steps are open again too."""

    type = "step_reopened"
    step: int
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class PhasePrepared(Event):
    """A timed phase was called; the headset counts its preparation down."""

    type = "phase_prepared"
    step: int
    phase_id: int
    attempt: int
    latency_ms: float


@dataclass(frozen=True, kw_only=True)
class PhaseStarted(Event):
    """The headset started the phase's clock."""

    type = "phase_started"
    phase_id: int
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class PauseRequested(Event):
    """The operator asked for a pause."""

    type = "pause_requested"
    phase_id: int
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class PhasePaused(Event):
    """The clock stands. `cause`: operator, headset_lost, server_restarted or headset.

    Where the headset could not be asked, `client_t_s` is null and `active_s` the last stored value;
    the headset's own report follows when it is back.
    """

    type = "phase_paused"
    phase_id: int
    active_s: float
    cause: str
    client_t_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class ResumeRequested(Event):
    """The operator asked to go on."""

    type = "resume_requested"
    phase_id: int


@dataclass(frozen=True, kw_only=True)
class PhaseResumed(Event):
    """The clock runs again."""

    type = "phase_resumed"
    phase_id: int
    active_s: float
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class WalkBackStarted(Event):
    """A foot task was completed: the clock stands while the participant walks back."""

    type = "walk_back_started"
    phase_id: int
    active_s: float
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class WalkBackEnded(Event):
    """The start square was reached: the clock runs again."""

    type = "walk_back_ended"
    phase_id: int
    active_s: float
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class PhaseFrozen(Event):
    """The active time is used up; scene and avatar freeze."""

    type = "phase_frozen"
    phase_id: int
    active_s: float
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class PhaseEnded(Event):
    """The freeze is over; the phase counts."""

    type = "phase_ended"
    phase_id: int
    active_s: float
    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class PhaseVoided(Event):
    """The phase does not count (redo, skip, abort, withdraw); its data stay."""

    type = "phase_voided"
    phase_id: int
    cause: str


@dataclass(frozen=True, kw_only=True)
class SessionEnded(Event):
    """The session is over: completed, aborted or withdrawn."""

    type = "session_ended"
    status: str
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class BlindingLifted(Event):
    """The session's condition was shown to somebody on purpose, for the reason given."""

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
    """The headset took up a physics avatar: how it behaves, by the hash of its configuration.

    The content holds the stature it was built for and the model itself.
    """

    type = "avatar_built"
    configuration_hash: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class CheckOverridden(Event):
    """Somebody goes on although the pre-flight's check `check` was not green.

    The content holds the reason, and what the check had found.
    """

    type = "check_overridden"
    check: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class FormRefused(Event):
    """Other answers came for a form that is stored: that one stands, these are kept beside."""

    type = "form_refused"
    submission_id: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class AnswersCorrected(Event):
    """A stored answer was corrected: the first one is kept, the newest counts."""

    type = "answers_corrected"
    submission_id: str
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class DataErased(Event):
    """The participant's data are gone; `erasure_id` is the tombstone's.

    `reason_code`: withdrawn, requested, retention or mistake.
    """

    type = "data_erased"
    erasure_id: str
    reason_code: str


@dataclass(frozen=True, kw_only=True)
class StopRuleMet(Event):
    """A form met a stop rule of the study, by its index: the session is held from here."""

    type = "stop_rule_met"
    rule: int
    submission_id: str


@dataclass(frozen=True, kw_only=True)
class StopRuleOverridden(Event):
    """The operator goes on although a stop rule was met, for the reason given."""

    type = "stop_rule_overridden"
    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class ConsentRefused(Event):
    """The participant does not want to take part: the session is held from here."""

    type = "consent_refused"
    step: int
    by: str


@dataclass(frozen=True, kw_only=True)
class RefusalRetracted(Event):
    """The participant changed their mind: nothing is agreed to, the consent is shown again.

    By the tablet or the operator; the operator's reason is content.
    """

    type = "refusal_retracted"
    step: int
    by: str
    content_id: str | None = None
    content_hash: str | None = None


@dataclass(frozen=True, kw_only=True)
class QuestionAsked(Event):
    """The participant has a question about the text of a step, null before the start."""

    type = "question_asked"
    step: int | None = None


@dataclass(frozen=True, kw_only=True)
class QuestionClosed(Event):
    """The question is over. `outcome`: answered by the experimenter, or taken_back."""

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
    """The payload of an event; its type is stored beside it."""
    return asdict(event)


def event_from_json(event_type: str, payload: dict[str, Any]) -> Event:
    """The event that was stored; raises KeyError for a type this version does not know."""
    return _ADAPTERS[event_type].validate_python(payload)
