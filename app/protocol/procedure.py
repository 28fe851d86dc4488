"""The procedure of a session, step by step: before the blocks, in each block, and after them.

A *block* is one condition; its *phases* are done one after the other, each followed by its
questionnaire. `text` is the key of one of the study's texts; `title` replaces the built-in step
title.
"""

from typing import Annotated, ClassVar, Literal, Self

from pydantic import AfterValidator, Field, model_validator

from app.protocol.avatar_changes import AvatarChanges
from app.protocol.common import Duration, Key, Pause, Strict, Text, refusal
from app.protocol.conditions import LatencyMs
from app.protocol.step_kinds import StepKind
from app.science.tasks import Limb

OfThePhase = Annotated[AvatarChanges | None, Field(exclude_if=lambda value: value is None)]
"""Changes to the physics avatar from the phase's preparation to its end.

Left out of the content if not set, so that the hashes of other studies stay the same.
"""


FormPlace = Literal["tablet", "headset", "oral"]
OfTheForm = Annotated[FormPlace, Field(exclude_if=lambda value: value == "tablet")]
"""Where the participant answers: on the tablet, inside the headset, or aloud.

For answers given aloud, the experimenter asks and enters them. Left out of the content if it is the
tablet, so that the hashes of other studies stay the same.
"""


class Statement(Strict):
    """One statement of a consent with its own tick box, required unless `optional`.

    An optional one asks for a permission that a participant may withhold and still take part, such
    as the use of their data in later studies.
    """

    text: Text
    optional: bool = False


class ConsentStep(Strict):
    """A step in which the participant reads the consent text and agrees, or the session ends.

    `signature`: "none" is a button, "typed" a name, "drawn" a signature by finger, pen or mouse
    (participants who cannot draw type their name). `statements`: each has its own tick box.
    """

    step: Literal["consent"]
    text: Key
    title: Text | None = None
    # Left out of the content if not used, so that the hashes of other studies stay the same.
    signature: Annotated[
        Literal["none", "typed", "drawn"], Field(exclude_if=lambda value: value == "none")
    ] = "none"
    statements: Annotated[
        tuple[Statement, ...], Field(max_length=20, exclude_if=lambda value: not value)
    ] = ()


class FormStep(Strict):
    """A step in which the participant answers an instrument; `forms` says where."""

    step: Literal["form"]
    instrument: Key
    forms: OfTheForm = "tablet"
    title: Text | None = None


class InstructionsStep(Strict):
    """A step in which the participant reads a text and can ask questions."""

    step: Literal["instructions"]
    text: Key
    title: Text | None = None


class HeightStep(Strict):
    """A step in which the avatar is matched to the participant's height.

    The stated and matched values are stored.
    """

    step: Literal["height"]
    text: Key | None = None
    title: Text | None = None


class MaterialiseStep(Strict):
    """A step in which the participant stands inside the avatar in T-pose and presses the grips."""

    step: Literal["materialise"]
    text: Key | None = None
    title: Text | None = None


class FreeRoamStep(Strict):
    """A step in which the participant gets used to the body for a while, with its own latency."""

    step: Literal["free_roam"]
    duration_s: Duration
    latency_ms: LatencyMs
    text: Key | None = None
    title: Text | None = None
    avatar_changes: OfThePhase = None


class PracticeStep(Strict):
    """A practice of a task, with boxes, clock and freeze as in a block, but never analysed.

    It has its own latency. `repeat_until_completions`: it ends once this many tasks are completed,
    or when its time is up.
    """

    step: Literal["practice"]
    limb: Limb
    preparation_s: Pause
    duration_s: Duration
    freeze_s: Pause
    latency_ms: LatencyMs
    repeat_until_completions: Annotated[
        int | None, Field(ge=1, le=100, exclude_if=lambda value: value is None)
    ] = None
    text: Key | None = None
    title: Text | None = None
    avatar_changes: OfThePhase = None


class DebriefStep(Strict):
    """A step in which the purpose of the study is explained to the participant."""

    step: Literal["debrief"]
    text: Key
    title: Text | None = None


SetupStep = Annotated[
    ConsentStep
    | FormStep
    | InstructionsStep
    | HeightStep
    | MaterialiseStep
    | FreeRoamStep
    | PracticeStep,
    Field(discriminator="step"),
]
ClosingStep = Annotated[FormStep | InstructionsStep | DebriefStep, Field(discriminator="step")]


class TimedPhase(Strict):
    """A phase with a clock. `duration_s` is active time: pauses and walks back do not count.

    `preparation_s`: countdown before it; `freeze_s`: scene and body are frozen after it. `forms`:
    where its questionnaire is answered.
    """

    preparation_s: Pause
    duration_s: Duration
    freeze_s: Pause
    questionnaire: Key
    forms: OfTheForm = "tablet"
    text: Key | None = None
    title: Text | None = None
    questionnaire_title: Text | None = None
    avatar_changes: OfThePhase = None


class TaskPhase(TimedPhase):
    """One timed task of a hand or a foot."""

    limb: Limb


def _each_limb_once(phases: tuple[TaskPhase, ...]) -> tuple[TaskPhase, ...]:
    limbs = [phase.limb for phase in phases]
    if len(set(limbs)) < len(limbs):
        raise refusal(
            "A limb has two phases in one block.",
            value=[str(limb) for limb in limbs],
            valid="hand and foot, each at most once",
            remedy="Keep one phase for each limb.",
        )
    return phases


class CrossingPhase(TimedPhase):
    """The participant crosses the study's road, there and back, `crossings` times in all.

    It ends after that many crossings, or when `duration_s` of active time are over.
    """

    kind: ClassVar[StepKind] = "road_crossing"
    crossings: Annotated[int, Field(ge=1, le=100)] = 1


class Block(Strict):
    """The phases of one condition.

    `crossing`: the participant first crosses the study's road; `phases` may then be empty.

    `limb_order`: "fixed" as listed; "alternate" reverses the order in every other block. `after`:
    forms answered at the end of every block, such as a sickness scale.
    """

    limb_order: Literal["fixed", "alternate"]
    phases: Annotated[tuple[TaskPhase, ...], AfterValidator(_each_limb_once)]
    crossing: Annotated[CrossingPhase | None, Field(exclude_if=lambda value: value is None)] = None
    # Left out of the content if empty, so that the hashes of other studies stay the same.
    after: Annotated[tuple[FormStep, ...], Field(exclude_if=lambda steps: not steps)] = ()

    @model_validator(mode="after")
    def _has_a_phase(self) -> Self:
        if not self.phases and self.crossing is None:
            raise refusal(
                "A block has no phase.",
                value=[],
                valid="at least one task, or a crossing",
                remedy="Add a phase with its limb, or a crossing.",
                at=("phases",),
            )
        return self


class Procedure(Strict):
    """The steps of a whole session."""

    before: tuple[SetupStep, ...]
    block: Block
    after: tuple[ClosingStep, ...]
