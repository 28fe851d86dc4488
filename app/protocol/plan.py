"""From a study and one order of its conditions to the steps of a session.

The plan is what a session walks through: setup steps, then for each condition its phases, each
followed by its questionnaire, and the block's own forms, then the closing steps. It never changes
during a session.
"""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from app.protocol.common import Text
from app.protocol.conditions import Condition
from app.protocol.errors import PlanError
from app.protocol.procedure import (
    ClosingStep,
    ConsentStep,
    FormStep,
    FreeRoamStep,
    PracticeStep,
    SetupStep,
    TaskPhase,
)
from app.protocol.study import StudyProtocol
from app.science.tasks import Limb

DEFAULT_TITLES: dict[str, dict[str, str]] = {
    "consent": {"en": "Consent", "de": "Einwilligung"},
    "form": {"en": "Questions", "de": "Fragen"},
    "instructions": {"en": "Instructions", "de": "Anleitung"},
    "height": {"en": "Height", "de": "Körpergröße"},
    "materialise": {"en": "Entering the body", "de": "Eintritt in den Körper"},
    "free_roam": {"en": "Free movement", "de": "Freies Bewegen"},
    "practice_hand": {"en": "Practice with the hand", "de": "Übung mit der Hand"},
    "practice_foot": {"en": "Practice with the foot", "de": "Übung mit dem Fuß"},
    "hand": {"en": "Hand task", "de": "Handaufgabe"},
    "foot": {"en": "Foot task", "de": "Fußaufgabe"},
    "questionnaire": {"en": "Questionnaire", "de": "Fragebogen"},
    "debrief": {"en": "Debriefing", "de": "Abschluss"},
}
DEFAULT_LANGUAGES = frozenset({"en", "de"})
StepKind = Literal[
    "consent",
    "form",
    "instructions",
    "height",
    "materialise",
    "free_roam",
    "practice",
    "task",
    "questionnaire",
    "debrief",
]


TIMED_KINDS: tuple[StepKind, ...] = ("free_roam", "practice", "task")
"""Steps that are phases: they run on the headset's clock and are recorded as such."""


def title_of(kind: str, given: Mapping[str, str] | None) -> Mapping[str, str]:
    """The given title, or the built-in one of the step's kind (of its limb for a task)."""
    return DEFAULT_TITLES[kind] if given is None else given


@dataclass(frozen=True)
class Step:
    """One step of a session.

    `index` counts from 0; `key` is unique ("form.demographics", "block2.hand",
    "block2.hand.karas2020", "block2.fms"). `block` counts from 1 and, like `condition`, is None
    outside the blocks. `latency_ms` is also set for free movement and practice. `text` names a text
    of the study. `until_completions`: a practice ends early after so many tasks. `consent`: what a
    consent asks for besides its text.
    """

    index: int
    key: str
    kind: StepKind
    title: Text
    block: int | None = None
    condition: str | None = None
    latency_ms: float | None = None
    limb: Limb | None = None
    preparation_s: float | None = None
    duration_s: float | None = None
    freeze_s: float | None = None
    instrument: str | None = None
    text: str | None = None
    until_completions: int | None = None
    consent: ConsentStep | None = None

    @property
    def phase_key(self) -> str | None:
        """What rules call a timed step: hand, foot, free_roam, practice_hand, practice_foot."""
        match self.kind:
            case "task":
                return str(self.limb)
            case "practice":
                return f"practice_{self.limb}"
            case "free_roam":
                return "free_roam"
            case _:
                return None


def compile_plan(
    protocol: StudyProtocol, sequence: Sequence[str], *, block_limb_flip: bool = False
) -> tuple[Step, ...]:
    """All steps of a session in which the conditions come in the order `sequence` (their keys).

    With `limb_order: alternate` every other block has its phases turned round: the even ones (2, 4,
    ...), or with `block_limb_flip` the odd ones, so that a caller can balance it over people. With
    `limb_order: fixed` the flip has no effect. Raises PlanError unless `sequence` names each
    condition exactly once.
    """
    known = [condition.key for condition in protocol.conditions]
    if sorted(sequence) != sorted(known):
        raise PlanError(
            f"The order {list(sequence)} does not fit the study. "
            f"Name each of {', '.join(known)} exactly once."
        )
    steps = [_simple(step) for step in protocol.procedure.before]
    for block, key in enumerate(sequence, start=1):
        phases = protocol.procedure.block.phases
        turned = block % 2 == (1 if block_limb_flip else 0)
        if protocol.procedure.block.limb_order == "alternate" and turned:
            phases = phases[::-1]
        condition = protocol.condition(key)
        steps.extend(_block(block, condition, phases))
        steps.extend(
            replace(
                _simple(step),
                key=f"block{block}.{step.instrument}",
                block=block,
                condition=condition.key,
                latency_ms=condition.latency_ms,
            )
            for step in protocol.procedure.block.after
        )
    steps.extend(_simple(step) for step in protocol.procedure.after)
    return tuple(_numbered(steps))


def _simple(step: SetupStep | ClosingStep) -> Step:
    """A step outside the blocks."""
    if isinstance(step, PracticeStep):
        return _practice(step)
    title = title_of(step.step, step.title)
    if isinstance(step, FormStep):
        key = f"form.{step.instrument}"
        return Step(0, key, "form", title, instrument=step.instrument)
    plain = Step(0, step.step, step.step, title, text=step.text)
    if isinstance(step, ConsentStep):
        return replace(plain, consent=step)
    if isinstance(step, FreeRoamStep):
        return replace(plain, latency_ms=step.latency_ms, duration_s=step.duration_s)
    return plain


def _practice(step: PracticeStep) -> Step:
    return Step(
        0,
        f"practice.{step.limb}",
        "practice",
        title_of(f"practice_{step.limb}", step.title),
        latency_ms=step.latency_ms,
        limb=step.limb,
        preparation_s=step.preparation_s,
        duration_s=step.duration_s,
        freeze_s=step.freeze_s,
        text=step.text,
        until_completions=step.repeat_until_completions,
    )


def _block(block: int, condition: Condition, phases: Sequence[TaskPhase]) -> Iterator[Step]:
    for phase in phases:
        key = f"block{block}.{phase.limb}"
        task = Step(
            0,
            key,
            "task",
            title_of(phase.limb, phase.title),
            block=block,
            condition=condition.key,
            latency_ms=condition.latency_ms,
            limb=phase.limb,
            preparation_s=phase.preparation_s,
            duration_s=phase.duration_s,
            freeze_s=phase.freeze_s,
            text=phase.text,
        )
        yield task
        yield replace(
            task,
            key=f"{key}.{phase.questionnaire}",
            kind="questionnaire",
            title=title_of("questionnaire", phase.questionnaire_title),
            preparation_s=None,
            duration_s=None,
            freeze_s=None,
            instrument=phase.questionnaire,
            text=None,
        )


def _numbered(steps: Sequence[Step]) -> Iterator[Step]:
    """Give each step its index, and a repeated step a key of its own: consent, consent.2."""
    seen: dict[str, int] = {}
    for index, step in enumerate(steps):
        count = seen[step.key] = seen.get(step.key, 0) + 1
        yield replace(step, index=index, key=step.key if count == 1 else f"{step.key}.{count}")
