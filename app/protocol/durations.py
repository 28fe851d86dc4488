"""Estimate how long a visit takes: the plan of one participant with the time of each step.

Timed steps take what the study specifies: preparation, active time and freeze. Pauses and walks
back are additional and cannot be planned. All other steps are estimated by our own rough rule
below: a reading speed, a time for each kind of item, and a time for matching the height and
entering the body. An estimate is always marked as one.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from app.protocol.orders import sequences
from app.protocol.plan import Step, compile_plan
from app.protocol.step_kinds import STEP_KINDS
from app.protocol.study import StudyProtocol
from app.science.instruments import Instrument

READING_WORDS_PER_S = 3.0
"""Unhurried silent reading of instructions, about 180 words a minute."""
OPENING_S = 10.0
"""Time to find one's way into a page or a form."""
BY_HAND_S = {kind: one.takes_s for kind, one in STEP_KINDS.items() if one.takes_s is not None}
"""Time of the steps in which the experimenter and the participant do something together."""
ITEM_S = {"likert": 6.0, "boolean": 4.0, "choice": 5.0, "integer": 8.0, "number": 8.0, "text": 20.0}
"""Time of one answer by the type of its item, including reading the question."""


@dataclass(frozen=True)
class TimedStep:
    """A step with its time in seconds.

    `estimated`: whether the time comes from our rule instead of the study.
    """

    step: Step
    start_s: float
    length_s: float
    estimated: bool


def timeline(
    protocol: StudyProtocol,
    plan: Sequence[Step],
    instruments: Mapping[str, Instrument],
    *,
    language: str,
) -> tuple[TimedStep, ...]:
    """Return the steps of `plan` with their times; texts are read in `language`."""
    timed: list[TimedStep] = []
    start_s = 0.0
    for step in plan:
        planned_s = _planned_s(step)
        estimated = planned_s is None
        length_s = (
            _estimated_s(protocol, step, instruments, language)
            if planned_s is None
            else (planned_s)
        )
        timed.append(TimedStep(step, start_s, length_s, estimated))
        start_s += length_s
    return tuple(timed)


def total_s(steps: Sequence[TimedStep]) -> float:
    """Return the length of the whole visit in seconds."""
    return sum(step.length_s for step in steps)


@dataclass(frozen=True)
class VisitTime:
    """The length of a visit in minutes, to a tenth.

    `planned`: the time that the study specifies. `total`: that time plus our estimate of forms,
    texts and steps by hand; pauses, and putting on the equipment, are additional.
    """

    planned: float
    total: float


def visit_time(protocol: StudyProtocol, instruments: Mapping[str, Instrument]) -> VisitTime:
    """Return the time of a visit in the first order and language, the figure shown everywhere."""
    plan = compile_plan(protocol, sequences(protocol)[0])
    steps = timeline(protocol, plan, instruments, language=protocol.languages[0])
    return VisitTime(round(planned_s(steps) / 60, 1), round(total_s(steps) / 60, 1))


def planned_s(steps: Sequence[TimedStep]) -> float:
    """Return the time that the study specifies, in seconds."""
    return sum(step.length_s for step in steps if not step.estimated)


def form_s(instrument: Instrument) -> float:
    """Return the estimated time to fill in an instrument, in seconds."""
    return OPENING_S + sum(ITEM_S[item.type] for item in instrument.items)


def _planned_s(step: Step) -> float | None:
    if step.duration_s is None:
        return None
    return (step.preparation_s or 0.0) + step.duration_s + (step.freeze_s or 0.0)


def _estimated_s(
    protocol: StudyProtocol, step: Step, instruments: Mapping[str, Instrument], language: str
) -> float:
    if step.instrument is not None:
        instrument = instruments.get(step.instrument)
        return OPENING_S if instrument is None else form_s(instrument)
    wording = protocol.texts.get(step.text, {}) if step.text is not None else {}
    words = len(wording.get(language, "").split())
    return round(BY_HAND_S.get(step.kind, OPENING_S) + words / READING_WORDS_PER_S)
