"""What can be asked of a session: by the operator, the tablet, the headset, or the server."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ContentRef:
    """Words stored elsewhere: their id and salted hash."""

    content_id: str
    content_hash: str


@dataclass(frozen=True, kw_only=True)
class Command:
    """Base of all commands."""


@dataclass(frozen=True, kw_only=True)
class Start(Command):
    """Start the session."""


@dataclass(frozen=True, kw_only=True)
class CompleteStep(Command):
    """The current step without a clock is done (consent given, instructions read, ...).

    `step` guards against a late click: it must be the current one where it is given.
    """

    by: str
    step: int | None = None
    content: ContentRef | None = None


@dataclass(frozen=True, kw_only=True)
class SubmitForm(Command):
    """The form of step `step` was stored as `submission_id`.

    `rules_met`: which stop rules of the study its scores meet, by their index.
    """

    step: int
    submission_id: str
    content_hash: str
    rules_met: tuple[int, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Materialise(Command):
    """The participant stands in T-pose and the avatar appears."""

    by: str
    headset_connected: bool
    client_t_s: float | None = None


@dataclass(frozen=True, kw_only=True)
class BeginPhase(Command):
    """Call the current timed step."""

    headset_connected: bool


@dataclass(frozen=True, kw_only=True)
class Pause(Command):
    """Stop the clock."""

    content: ContentRef | None = None


@dataclass(frozen=True, kw_only=True)
class Resume(Command):
    """Let the clock go on."""

    headset_connected: bool


@dataclass(frozen=True, kw_only=True)
class Redo(Command):
    """Do step `step` (the current one if None) over, and what came after it."""

    content: ContentRef
    step: int | None = None


@dataclass(frozen=True, kw_only=True)
class Skip(Command):
    """Leave the current step out."""

    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class Stop(Command):
    """End the session before its time: `aborted` by the lab or `withdrawn` by the participant."""

    status: str
    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class RefuseConsent(Command):
    """The participant does not want to take part: said at the consent of step `step`.

    It may come late, from a tablet that was offline: so the step need not be the current one.
    """

    by: str
    step: int


@dataclass(frozen=True, kw_only=True)
class RetractRefusal(Command):
    """The participant has changed their mind and wants to see the consent again.

    By the tablet where they said so there, else by the operator, whose `content` holds the reason.
    """

    by: str
    content: ContentRef | None = None


@dataclass(frozen=True, kw_only=True)
class AskQuestion(Command):
    """The participant has a question about what the tablet shows."""


@dataclass(frozen=True, kw_only=True)
class CloseQuestion(Command):
    """The question is `answered`, or was `taken_back` by the participant."""

    outcome: str


@dataclass(frozen=True, kw_only=True)
class LiftBlinding(Command):
    """Show the condition of a blinded session before it is over."""

    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class OverrideStop(Command):
    """Go on although a stop rule was met."""

    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class AddNote(Command):
    """Write something down."""

    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class RecordAvatar(Command):
    """The headset takes up a physics avatar; `content` holds its model."""

    configuration_hash: str
    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class OverrideCheck(Command):
    """Go on although the pre-flight's check is not green; `content` holds reason and finding."""

    check: str
    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class KeepRefusedForm(Command):
    """Other answers came for a form that is stored; `submission_id` is the one that stands."""

    submission_id: str
    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class CorrectAnswers(Command):
    """A stored answer is wrong; `content` holds the item, both values and the reason."""

    submission_id: str
    content: ContentRef


@dataclass(frozen=True, kw_only=True)
class EraseData(Command):
    """The participant's data are erased from this session, for the reason of this code.

    `even_though_active`: a backup was restored in which the session had not ended yet.
    """

    erasure_id: str
    reason_code: str
    even_though_active: bool = False


@dataclass(frozen=True, kw_only=True)
class Report(Command):
    """What the headset did to a phase's clock, at its own time.

    `what`: started, paused, resumed, walk_back_started, walk_back_ended, time_up or ended.
    `completions`: how many tasks of the phase are stored, counted by the server.
    """

    what: str
    phase_id: int
    client_t_s: float
    active_s: float
    cause: str = "headset"
    completions: int = 0


@dataclass(frozen=True, kw_only=True)
class HeadsetLost(Command):
    """The headset's connection or the server broke off; `active_s` is the last stored value."""

    active_s: float
    cause: str


class Refused(ValueError):
    """A command that cannot be done now: what, the value met, what would be valid, the way out."""

    def __init__(self, message: str, *, value: object, valid: object, remedy: str = "") -> None:
        super().__init__(message)
        self.message = message
        self.value = value
        self.valid = valid
        self.remedy = remedy
