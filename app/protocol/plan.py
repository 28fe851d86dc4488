"""Compile a study and one order of its conditions into the steps of a session.

The plan is the list of steps that a session goes through: setup steps, then for each condition its
phases, each followed by its questionnaire, and the block's own forms, then the closing steps. It
never changes during a session.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from app.protocol.avatar_changes import AvatarChanges
from app.protocol.common import Text
from app.protocol.conditions import Condition
from app.protocol.errors import PlanError
from app.protocol.procedure import (
    ClosingStep,
    ConsentStep,
    CrossingPhase,
    FormPlace,
    FormStep,
    SetupStep,
    TaskPhase,
)
from app.protocol.step_kinds import STEP_KINDS, StepKind, StepKindSpec
from app.protocol.study import StudyProtocol
from app.science.tasks import Limb

_OF_TIMED_STEPS = (
    "latency_ms", "limb", "preparation_s", "duration_s", "freeze_s", "avatar_changes"
)  # fmt: skip
"""Fields that a step of the plan copies from a timed step of the study, if that has them."""


@dataclass(frozen=True)
class Step:
    """One step of a session.

    `index` counts from 0; `key` is unique ("form.demographics", "block2.hand",
    "block2.hand.karas2020", "block2.fms"). `block` counts from 1 and, like `condition`, is None
    outside the blocks. `latency_ms` is also set for free movement and practice. `body`: the body
    that the condition prescribes, None for that of the avatar's configuration. `text` is the key
    of a text of the study. `until_completions`: the phase ends early after this many tasks or
    crossings. `consent`: the requirements of a consent step in addition to its text.
    `avatar_changes`: how a timed step changes the physics avatar while the step lasts. `forms`:
    where a form is answered.
    """

    index: int
    key: str
    kind: StepKind
    title: Text
    block: int | None = None
    condition: str | None = None
    latency_ms: float | None = None
    body: str | None = None
    limb: Limb | None = None
    preparation_s: float | None = None
    duration_s: float | None = None
    freeze_s: float | None = None
    instrument: str | None = None
    text: str | None = None
    until_completions: int | None = None
    consent: ConsentStep | None = None
    avatar_changes: AvatarChanges | None = None
    forms: FormPlace = "tablet"

    @property
    def spec(self) -> StepKindSpec:
        """The properties of all steps of this kind."""
        return STEP_KINDS[self.kind]

    @property
    def phase_key(self) -> str | None:
        """The key of a timed step in rules: hand, foot, free_roam, practice_hand, practice_foot."""
        return self.spec.key_of_phase(self.limb)


def compile_plan(
    protocol: StudyProtocol, sequence: Sequence[str], *, block_limb_flip: bool = False
) -> tuple[Step, ...]:
    """Return all steps of a session with the conditions in the order `sequence` (their keys).

    With `limb_order: alternate` every other block has its phases reversed: the even ones (2, 4,
    ...), or with `block_limb_flip` the odd ones, so that a caller can balance it over participants.
    With `limb_order: fixed` the flip has no effect. Raises PlanError unless `sequence` names each
    condition exactly once.
    """
    keys = [condition.key for condition in protocol.conditions]
    if sorted(sequence) != sorted(keys):
        raise PlanError(
            f"The order {list(sequence)} does not match the study. "
            f"Name each of {', '.join(keys)} exactly once."
        )
    steps = [_simple(step) for step in protocol.procedure.before]
    for block, key in enumerate(sequence, start=1):
        phases = protocol.procedure.block.phases
        turned = block % 2 == (1 if block_limb_flip else 0)
        if protocol.procedure.block.limb_order == "alternate" and turned:
            phases = phases[::-1]
        condition = protocol.condition(key)
        crossing = protocol.procedure.block.crossing
        first = () if crossing is None else (crossing,)
        steps.extend(_block(block, condition, (*first, *phases)))
        steps.extend(
            replace(
                _simple(step),
                key=f"block{block}.{step.instrument}",
                block=block,
                condition=condition.key,
                latency_ms=condition.latency_ms,
                body=condition.body,
            )
            for step in protocol.procedure.block.after
        )
    steps.extend(_simple(step) for step in protocol.procedure.after)
    return tuple(_numbered(steps))


def _simple(step: SetupStep | ClosingStep) -> Step:
    """Return the plan's step for a step outside the blocks."""
    kind = step.step
    if isinstance(step, FormStep):
        title = _title(kind, None, step.title)
        key = f"form.{step.instrument}"
        return Step(0, key, kind, title, instrument=step.instrument, forms=step.forms)
    timed = {name: getattr(step, name) for name in _OF_TIMED_STEPS if hasattr(step, name)}
    limb = timed.get("limb")
    return Step(
        0,
        kind if limb is None else f"{kind}.{limb}",
        kind,
        _title(kind, limb, step.title),
        text=step.text,
        until_completions=getattr(step, "repeat_until_completions", None),
        consent=step if isinstance(step, ConsentStep) else None,
        **timed,
    )


def _title(kind: StepKind, limb: Limb | None, given: Text | None) -> Text:
    """Return the title that the study specifies, or the built-in one of the kind and limb."""
    return STEP_KINDS[kind].title(limb) if given is None else given


def _block(
    block: int, condition: Condition, phases: Sequence[TaskPhase | CrossingPhase]
) -> Iterator[Step]:
    for phase in phases:
        kind: StepKind = phase.kind if isinstance(phase, CrossingPhase) else "task"
        limb = None if isinstance(phase, CrossingPhase) else phase.limb
        crossings = phase.crossings if isinstance(phase, CrossingPhase) else None
        key = f"block{block}.{STEP_KINDS[kind].key_of_phase(limb)}"
        task = Step(
            0,
            key,
            kind,
            _title(kind, limb, phase.title),
            block=block,
            condition=condition.key,
            latency_ms=condition.latency_ms,
            body=condition.body,
            limb=limb,
            preparation_s=phase.preparation_s,
            duration_s=phase.duration_s,
            freeze_s=phase.freeze_s,
            text=phase.text,
            avatar_changes=phase.avatar_changes,
            until_completions=crossings,
        )
        yield task
        yield replace(
            task,
            key=f"{key}.{phase.questionnaire}",
            kind="questionnaire",
            title=_title("questionnaire", None, phase.questionnaire_title),
            preparation_s=None,
            duration_s=None,
            freeze_s=None,
            instrument=phase.questionnaire,
            forms=phase.forms,
            text=None,
            avatar_changes=None,
            until_completions=None,
        )


def _numbered(steps: Sequence[Step]) -> Iterator[Step]:
    """Give each step its index, and repeated steps unique keys: consent, consent.2."""
    seen: dict[str, int] = {}
    for index, step in enumerate(steps):
        count = seen[step.key] = seen.get(step.key, 0) + 1
        yield replace(step, index=index, key=step.key if count == 1 else f"{step.key}.{count}")
