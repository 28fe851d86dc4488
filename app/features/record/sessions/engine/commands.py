"""The commands of a session, issued by the operator, the tablet, the headset, or the server."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from app.features.record.sessions.engine.events import Companion


@dataclass(frozen=True)
class ContentRef:
    """A reference to a text stored as content: its id and salted hash."""

    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class Command:
    """The base class of all commands."""


@dataclass(frozen=True, kw_only=True)
class Start(Command):
    """Start the session."""


@dataclass(frozen=True, kw_only=True)
class CompleteStep(Command):
    """Complete the current step, which has no clock (consent given, instructions read, ...).

    `step` guards against a late click: if given, it must be the current step.
    """

    by: str
    step: int | None = None
    content: ContentRef | None = None


@dataclass(frozen=True, kw_only=True)
class SubmitForm(Command):
    """Complete step `step`, whose form was stored as `submission_id`.

    `rules_met`: the indices of the study's stop rules that its scores meet.
    """

    step: int
    submission_id: str
    content_hash: str
    rules_met: tuple[int, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Materialise(Command):
    """Make the avatar appear, now that the participant stands in T-pose."""

    by: str
    headset_connected: bool
    client_t_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class BeginPhase(Command):
    """Prepare the phase of the current timed step.

    `feet_tracked`: whether the headset measures the feet; None if it does not say, or if somebody
    decided to proceed without.
    """

    headset_connected: bool
    feet_tracked: bool | None = None


@dataclass(frozen=True, kw_only=True)
class Pause(Command):
    """Request a pause of the phase's clock."""

    content: ContentRef | None = None


@dataclass(frozen=True, kw_only=True)
class Resume(Command):
    """Request that the phase's clock continues."""

    headset_connected: bool


@dataclass(frozen=True, kw_only=True)
class Redo(Command):
    """Repeat step `step` (the current one if None), and the steps after it."""

    content: ContentRef
    step: int | None = None


@dataclass(frozen=True, kw_only=True)
class Skip(Command):
    """Skip the current step."""

    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class Stop(Command):
    """End the session early: `aborted` by the lab or `withdrawn` by the participant."""

    status: str
    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class RefuseConsent(Command):
    """Record that the participant refuses to take part, at the consent of step `step`.

    It may arrive late, from a tablet that was offline, so the step need not be the current one.
    """

    by: str
    step: int


@dataclass(frozen=True, kw_only=True)
class RetractRefusal(Command):
    """Record that the participant has changed their mind and wants to see the consent again.

    It comes from the tablet, or else from the operator, whose `content` contains the reason.
    """

    by: str
    content: ContentRef | None = None


@dataclass(frozen=True, kw_only=True)
class AskQuestion(Command):
    """Record that the participant has a question about what the tablet shows."""


@dataclass(frozen=True, kw_only=True)
class CloseQuestion(Command):
    """Close the question: it was `answered`, or was `taken_back` by the participant."""

    outcome: str


@dataclass(frozen=True, kw_only=True)
class LiftBlinding(Command):
    """Show the condition of a blinded session before the session has ended."""

    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class OverrideStop(Command):
    """Continue the session although a stop rule was met."""

    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class AddNote(Command):
    """Add a note to the session."""

    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class RecordAvatar(Command):
    """Record that the headset uses a physics avatar; `content` contains its model.

    `body`: the name of the body that it wears; None for that of the configuration.
    """

    configuration_hash: str
    content: ContentRef
    body: str | None = None


@dataclass(frozen=True, kw_only=True)
class ChangeAvatar(Command):
    """Change the physics avatar while it runs.

    `changes`: the content of an `AvatarChanges`, which replaces the operator's earlier changes; if
    it is empty, they are taken back. `is_physics`: whether the session has a physics avatar.
    `headset_can`: whether the connected headset can change it; None if none is connected.
    """

    changes: Mapping[str, Any]
    is_physics: bool
    headset_can: bool | None
    content: ContentRef | None = None


@dataclass(frozen=True, kw_only=True)
class ReportAvatarChange(Command):
    """Record that the headset has changed the avatar, or that it could not.

    `revision` is that of the order. The content has the angles of casts, or the headset's problem.
    """

    revision: int
    applied: bool
    client_t_s: float
    content: ContentRef | None = None


@dataclass(frozen=True, kw_only=True)
class RequestCalibration(Command):
    """Ask the headset to calibrate again; the current step stays, a running phase is paused.

    `headset_can`: whether the connected headset can do so; None if none is connected.
    """

    headset_can: bool | None
    content: ContentRef | None = None


@dataclass(frozen=True, kw_only=True)
class ShiftTracker(Command):
    """Shift the joint of a goal from where its tracker says, by `shift_m` in all."""

    goal: str
    shift_m: tuple[float, float, float]
    headset_can: bool | None
    content: ContentRef | None = None


@dataclass(frozen=True, kw_only=True)
class ReportCalibration(Command):
    """Record a calibration that the headset has completed; `content` has what was measured."""

    cause: str
    client_t_s: float
    content: ContentRef
    revision: int | None = None


@dataclass(frozen=True, kw_only=True)
class ChooseTrackers(Command):
    """Let the headset use the lab's trackers of a source; both fields are None for none."""

    door: str | None
    source: str | None


@dataclass(frozen=True, kw_only=True)
class ChooseCompanion(Command):
    """Show a performer to the participant as another person; None: nobody any more."""

    companion: Companion | None


@dataclass(frozen=True, kw_only=True)
class ReportAlignment(Command):
    """Record a change of how the trackers lie in the headset's world; see `TrackersAligned`."""

    change: str
    alignment_id: str
    client_t_s: float
    delay_s: float | None = None
    residual_m: float | None = None
    uncertainty_m: float | None = None
    offset_m: float | None = None
    offset_rad: float | None = None


@dataclass(frozen=True, kw_only=True)
class AskToStop(Command):
    """Record that the participant wants to stop, and pause a running phase."""

    client_t_s: float


@dataclass(frozen=True, kw_only=True)
class CloseStop(Command):
    """Record that the wish to stop was `answered`, or was `taken_back` by the participant."""

    outcome: str


@dataclass(frozen=True, kw_only=True)
class OverrideCheck(Command):
    """Proceed although a pre-flight check is not green; `content` has the reason and finding."""

    check: str
    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class KeepRefusedForm(Command):
    """Record that different answers for the stored form `submission_id` were rejected."""

    submission_id: str
    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class CorrectAnswers(Command):
    """Correct a stored answer; `content` contains the item, both values and the reason."""

    submission_id: str
    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class EraseData(Command):
    """Record that the participant's data are erased from this session, with a reason code.

    `even_though_active`: a backup was restored in which the session had not ended yet.
    """

    erasure_id: str
    reason_code: str
    even_though_active: bool = False


@dataclass(frozen=True, kw_only=True)
class Report(Command):
    """A headset's report of a change to a phase's clock, at the headset's own time.

    `what`: started, paused, resumed, walk_back_started, walk_back_ended, time_up or ended.
    `completions`: how many completed tasks of the phase are stored, counted by the server.
    """

    what: str
    phase_id: int
    client_t_s: float
    active_s: float
    cause: str = "headset"
    completions: int = 0


@dataclass(frozen=True, kw_only=True)
class HeadsetLost(Command):
    """Record that the headset or the server failed; `active_s` is the last stored active time."""

    active_s: float
    cause: str


class Refused(ValueError):
    """A command cannot be carried out now; says why, the value found, what is valid, the remedy."""

    def __init__(self, message: str, *, value: object, valid: object, remedy: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.value = value
        self.valid = valid
        self.remedy = remedy
