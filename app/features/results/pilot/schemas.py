"""Request and response models of pilots; all that they describe is simulated."""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Annotated, Final, Literal

from pydantic import BaseModel, ConfigDict, Field

from app.features.results.pilot.order import (
    FEWEST_PARTICIPANTS,
    MOST_PARTICIPANTS,
    SETS,
    TARGET,
)
from app.protocol import PrimaryNames, PrimaryTest

State = Literal["simulating", "stopped", "ready", "failed"]
Avatar = Literal["physics", "physics_without_fingers", "delayed_copy"]
FindingKind = Literal[
    "out_of_reach",
    "phase_too_short",
    "latency_over_buffer",
    "unbalanced_orders",
    "scene_without_path",
    "never_significant",
]
MANY: Final = 0.25
"""The share of people without any task from which on that is a finding."""
Seed = Annotated[int, Field(strict=True, ge=0, le=2**31 - 1)]
Assumed = Annotated[str, Field(min_length=1, max_length=100_000, description="YAML")]
Counted = Annotated[int, Field(strict=True, ge=FEWEST_PARTICIPANTS, le=MOST_PARTICIPANTS)]


class NewCohort(BaseModel):
    """Simulated people who do all task phases of a visit.

    `avatar`: null for the study's own. `assumptions`: what is assumed of answers, as a file; with
    it, the power of the test is simulated, too.
    """

    model_config = ConfigDict(extra="forbid")

    kind: Literal["cohort"]
    participants: Annotated[int, Field(strict=True, ge=1, le=MOST_PARTICIPANTS)] = 12
    seed: Seed = 1
    avatar: Avatar | None = None
    assumptions: Assumed | None = None


class NewPowerRun(BaseModel):
    """The power of the study's test by number of participants.

    `sets`: data sets for each number, with the effect and without. `target`: the power wanted.
    """

    model_config = ConfigDict(extra="forbid")

    kind: Literal["power"]
    participants: Annotated[list[Counted], Field(min_length=1, max_length=20)]
    seed: Seed = 1
    sets: Annotated[int, Field(ge=50, le=10_000)] = SETS
    target: Annotated[float, Field(gt=0.0, lt=1.0)] = TARGET
    assumptions: Assumed


NewPilot = Annotated[NewCohort | NewPowerRun, Field(discriminator="kind")]


class PilotDefaults(BaseModel):
    """What a pilot of the study's newest version starts with.

    `numbers`: participants of a power run, around the planned number. `most_participants`: places
    of a closed ledger; null if it grows. `assumptions`: the file that comes with the product for
    this study, null if there is none; `assumptions_trouble`: why that one does not fit the version.
    `example`: a file made for the study, whose numbers are to be replaced; null if there is none.
    `person_s`: a rough estimate of the processor time for one person, by avatar.
    """

    version: int
    avatar: Avatar
    participants: int
    numbers: list[int]
    most_participants: int | None
    assumptions: str | None
    assumptions_trouble: str | None
    example: str | None
    person_s: dict[Avatar, float]


class PilotProgress(BaseModel):
    """How far a pilot is: `done` of `total` bodies, people or parts of the power curve.

    `waiting`: behind another pilot, or its process is starting. `held`: somebody is in a session.
    `remaining_s`: estimated time of this stage without waiting.
    """

    waiting: bool
    held: bool
    stage: Literal["check", "people", "power"]
    done: int
    total: int
    remaining_s: float | None


class ReachedView(BaseModel):
    """How a slow body got through the first task of a limb at the longest latency."""

    limb: str
    hand: str
    body: str
    stature_m: float
    latency_ms: float
    out_of_reach: list[str]
    completion_s: float | None


class FindingView(BaseModel):
    """What would break the study: its place in the file, and what to do."""

    kind: FindingKind
    path: str
    message: str
    remedy: str


@dataclass(frozen=True)
class PhaseFigures:
    """One limb at one latency: means over simulated people.

    `at_floor`: the share who complete nothing. `share_of_lowest`: completions over those at the
    lowest latency; None if there are none. `share_low`, `share_high`: Student's t interval of 95 %
    of the mean, over the same mean at the lowest latency, as if that were exact; None for one
    person, and in pilots of earlier releases.
    """

    limb: str
    latency_ms: float
    people: int
    completions: float
    completions_sd: float
    side_contacts: float
    contact_time_s: float
    out_of_order: float
    walk_back_s: float
    at_floor: float
    share_of_lowest: float | None
    share_low: float | None = None
    share_high: float | None = None


class WithoutTask(BaseModel):
    """How many people completed no task with a limb at a latency.

    `is_many`: so many that it is a finding of the cohort.
    """

    limb: str
    latency_ms: float
    people: int
    without: int
    is_many: bool


def without_task(phases: Sequence[PhaseFigures]) -> list[WithoutTask]:
    """Return the limbs and latencies at which somebody completes no task, the most people first."""
    found = [
        WithoutTask(
            limb=one.limb,
            latency_ms=one.latency_ms,
            people=one.people,
            without=round(one.at_floor * one.people),
            is_many=one.at_floor >= MANY,
        )
        for one in phases
        if one.at_floor > 0.0
    ]
    return sorted(found, key=lambda one: -one.without / one.people)


class ChangeView(BaseModel):
    """A measure's paired change from the lowest to the highest latency, with its t interval."""

    limb: str
    measure: Literal["completions", "side_contacts", "contact_time_s", "out_of_order"]
    people: int
    mean: float
    low: float
    high: float


class PublishedView(BaseModel):
    """A published performance at an end-to-end latency, of another task."""

    end_to_end_ms: float
    performance_percent: float


class CohortFigures(BaseModel):
    """The report of a cohort; `sha256` is that of its record, `failures` counts visits.

    `session_min` is the time that the protocol sets (`planned_min`; null in pilots of earlier
    releases), the simulated walks back, and an estimate of the rest; breaks are not in it.
    `problems` are those of the check, `without_task` what the people did. `ethics`: a text for the
    ethics form, by language.
    """

    sha256: str
    avatar: Avatar
    failures: int
    unfinished: int
    reach: list[ReachedView]
    problems: list[FindingView]
    phases: list[PhaseFigures]
    without_task: list[WithoutTask]
    changes: list[ChangeView]
    published: list[PublishedView]
    session_min: float
    planned_min: float | None = None
    walk_back_min: float
    storage_mb: float
    ethics: dict[str, str]


class PowerPointView(BaseModel):
    """Power and level at one number of participants, with Clopper-Pearson intervals of 95 %.

    `type_s`: the share of significant results with the wrong sign; `type_m`: how many times too
    large they are. Failed data sets count as not significant.
    """

    n: int
    sets: int
    power: float
    low: float
    high: float
    level: float
    level_low: float
    level_high: float
    failures: int
    level_failures: int
    mean_in_test: float
    type_s: float | None
    type_m: float | None
    mean_estimate: float | None


class AssumptionView(BaseModel):
    """One number that is assumed, with where it comes from."""

    name: str
    value: float | list[float]
    unit: str
    source: str


class PowerFigures(BaseModel):
    """A power curve; `preregistered` is false if only the assumptions name the test.

    `names`: for the keys in the test, as far as they are known. `score_range`: the lowest and the
    highest score that are possible; null if nobody states them, and in pilots of earlier releases.
    """

    planned_n: int
    alpha: float
    target: float
    sets: int
    preregistered: bool
    test: PrimaryTest
    names: PrimaryNames
    assumed_difference: float
    score_range: tuple[float, float] | None = None
    assumptions_sha256: str
    smallest_sufficient_n: int | None
    power: list[PowerPointView]
    assumptions: list[AssumptionView]


class PilotListed(BaseModel):
    """A pilot of a study, without its figures.

    `content_hash` is that of the study's `version`. `participants`: of a cohort one number.
    `session_min` and `walk_back_min`: the length of a visit, and of its walks back, as the finished
    cohort says; else null.
    """

    id: str
    kind: Literal["cohort", "power"]
    simulated: Literal[True] = True
    version: int
    content_hash: str
    participants: list[int]
    seed: int
    avatar: Avatar | None
    sets: int | None
    state: State
    progress: PilotProgress | None
    trouble: str | None
    session_min: float | None
    walk_back_min: float | None
    by: str
    at: datetime
    ended_at: datetime | None


class PilotView(PilotListed):
    """A pilot with its figures, as far as it has any.

    `preregistration`: a text for the preregistration, by language.
    """

    figures: CohortFigures | None
    power: PowerFigures | None
    preregistration: dict[str, str] | None
    processor_s: float | None
