"""What a simulated cohort says of a study: figures, and texts for forms."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np
from scipy import stats

from app.features.results.pilot.schemas import PhaseFigures, without_task
from app.features.results.pilot.simulation.check import Checked, Finding, Reached
from app.features.results.pilot.simulation.cohort import Cohort
from app.features.results.pilot.simulation.form_texts import (
    Rehearsed,
    Texts,
    ethics_texts,
    preregistration_texts,
)
from app.features.results.pilot.simulation.plan import PilotStudy
from app.features.results.pilot.simulation.power import Curve
from app.features.results.pilot.simulation.recorded_reaching import (
    reaching_assumptions,
    reaching_data,
)
from app.protocol import TIMED_KINDS, compile_plan, sequences, visit_time
from app.science.statistics import FloatArray
from app.simulated_people.visits import AvatarKind, PhaseOutcome, Visit, avatar_kind_of

MEASURES: Final = ("completions", "side_contacts", "contact_time_s", "out_of_order")
PUBLISHED: Final = {45.0: 66.0, 125.0: 61.5, 350.0: 36.0}
"""Motor performance in per cent by end-to-end latency in ms (Waltemate et al. 2016, ten people)."""
_MB_PER_MINUTE: Final = 2.03
"""Storage of a minute of both bodies at 90 Hz (docs/benchmarks.md, encoding)."""


@dataclass(frozen=True)
class Change:
    """A measure's paired change from the lowest to the highest latency, with its t interval."""

    limb: str
    measure: str
    people: int
    mean: float
    low: float
    high: float


@dataclass(frozen=True)
class CohortReport:
    """Everything that is said of a cohort.

    `title`: that of the study, by language. `own_avatar`: the kind of avatar that the study has,
    whichever the cohort had. `session_min`: the estimated length of a visit, with the mean of the
    walks back; the protocol sets `planned_min` of it. `storage_mb`: of one visit's
    recorded movement.
    """

    title: Mapping[str, str]
    own_avatar: AvatarKind
    cohort: Cohort
    cells: tuple[PhaseFigures, ...]
    changes: tuple[Change, ...]
    session_min: float
    planned_min: float
    walk_back_min: float
    storage_mb: float
    reached: tuple[Reached, ...]
    findings: tuple[Finding, ...]
    power: Curve | None


def report_on(
    pilot: PilotStudy, cohort: Cohort, checked: Checked, power: Curve | None
) -> CohortReport:
    """Summarise a cohort, with what a check of the study found."""
    study = pilot.study.protocol
    finished = [visit for visit in cohort.visits if visit.failure is None]
    back_s = [sum(_walk_back_s(one) for one in visit.phases) for visit in finished]
    back_min = float(np.mean(back_s)) / 60.0 if back_s else 0.0
    steps = compile_plan(study, sequences(study)[0])
    recorded_s = sum(
        (one.preparation_s or 0.0) + (one.duration_s or 0.0) + (one.freeze_s or 0.0)
        for one in steps
        if one.kind in TIMED_KINDS
    )
    cells = tuple(_cells(finished))
    time = visit_time(study, pilot.instruments)
    return CohortReport(
        title=study.title,
        own_avatar=avatar_kind_of(study),
        cohort=cohort,
        cells=cells,
        changes=tuple(_changes(finished)),
        session_min=time.total + back_min,
        planned_min=time.planned,
        walk_back_min=back_min,
        storage_mb=(recorded_s / 60.0 + back_min) * _MB_PER_MINUTE,
        reached=checked.reached,
        findings=checked.findings,
        power=power,
    )


def form_texts(report: CohortReport) -> Mapping[str, Texts]:
    """Return texts for the ethics form and the preregistration, each in both languages."""
    header = report.cohort.header
    rehearsed = Rehearsed(
        title=report.title,
        people=len(report.cohort.visits),
        seed=header["seed"],
        failures=failures_of(report.cohort),
        used=header["avatar"],
        own=report.own_avatar,
        session_min=report.session_min,
        planned_min=report.planned_min,
        walk_back_min=report.walk_back_min,
        storage_mb=report.storage_mb,
        reached=report.reached,
        without_task=without_task(report.cells) if report.cells else None,
        reaching=header.get("reaching"),
    )
    return {
        "ethics": ethics_texts(rehearsed),
        "preregistration": preregistration_texts(report.power),
    }


def paragraphs(report: CohortReport) -> Mapping[str, str]:
    """Return the texts for forms in English, as the command prints them; none of a part alone."""
    if report.cohort.unfinished:
        return {}
    return {name: texts["en"] for name, texts in form_texts(report).items()}


def report_data(report: CohortReport) -> dict[str, Any]:
    """Return the report as plain data, the JSON of `reembody pilot`."""
    header, curve = report.cohort.header, report.power
    recorded = header.get("reaching")
    assumed = [] if curve is None else curve.header["assumptions"]
    return {
        "simulated": True,
        "study": header["study"],
        "study_sha256": header["study_sha256"],
        "avatar": header["avatar"],
        "participants": header["participants"],
        "seed": header["seed"],
        "sha256": report.cohort.sha256,
        "real_time_factor": report.cohort.real_time_factor,
        "unfinished": report.cohort.unfinished,
        "missing_shards": report.cohort.missing,
        "failures": failures_of(report.cohort),
        "reach": [asdict(one) for one in report.reached],
        "problems": [asdict(one) for one in report.findings],
        "phases": [asdict(one) for one in report.cells],
        "without_task": [one.model_dump() for one in without_task(report.cells)],
        "changes": [asdict(one) for one in report.changes],
        "published": [
            {"end_to_end_ms": ms, "performance_percent": share} for ms, share in PUBLISHED.items()
        ],
        "session_min": report.session_min,
        "planned_min": report.planned_min,
        "walk_back_min": report.walk_back_min,
        "storage_mb": report.storage_mb,
        "power": [] if curve is None else [asdict(one) for one in curve.points],
        "assumptions": [*assumed, *(reaching_assumptions(recorded) if recorded else ())],
        "paragraphs": dict(paragraphs(report)),
        # Only a cohort whose hands move as recorded has these figures.
        **({"reaching": reaching_data(recorded, report.cohort.visits)} if recorded else {}),
    }


def failures_of(cohort: Cohort) -> int:
    """Return how many visits could not be completed."""
    return sum(visit.failure is not None for visit in cohort.visits)


def _walk_back_s(phase: PhaseOutcome) -> float:
    return max(0.0, phase.elapsed_s - phase.active_s)


def _cells(visits: Sequence[Visit]) -> Iterator[PhaseFigures]:
    for limb, by_latency in _by_limb(visits).items():
        lowest: float | None = None
        for latency_ms in sorted(by_latency):
            own = list(by_latency[latency_ms].values())
            tasks = np.array([one.completions for one in own], dtype=np.float64)
            if lowest is None:
                lowest = float(tasks.mean())
            low, high = _share_interval(tasks, lowest)
            yield PhaseFigures(
                limb=limb,
                latency_ms=latency_ms,
                people=len(own),
                completions=float(tasks.mean()),
                completions_sd=float(tasks.std(ddof=1)) if len(own) > 1 else 0.0,
                side_contacts=float(np.mean([one.side_contacts for one in own])),
                contact_time_s=float(np.mean([one.contact_time_s for one in own])),
                out_of_order=float(np.mean([one.out_of_order for one in own])),
                walk_back_s=float(np.mean([_walk_back_s(one) for one in own])),
                at_floor=float(np.mean(tasks == 0.0)),
                share_of_lowest=float(tasks.mean()) / lowest if lowest else None,
                share_low=low,
                share_high=high,
            )


def _share_interval(tasks: FloatArray, lowest: float) -> tuple[float | None, float | None]:
    """Return the interval of a mean over another one; None without an interval or that mean."""
    half = _half_interval(tasks)
    if half is None or not lowest:
        return None, None
    mean = float(tasks.mean())
    # Nobody completes less than nothing.
    return max(0.0, mean - half) / lowest, (mean + half) / lowest


def _half_interval(values: FloatArray) -> float | None:
    """Return half the t interval of 95 % of a mean; None for a single value."""
    if values.size < 2:
        return None
    quantile = stats.t.ppf(0.975, values.size - 1)
    return float(quantile * values.std(ddof=1) / np.sqrt(values.size))


def _changes(visits: Sequence[Visit]) -> Iterator[Change]:
    for limb, by_latency in _by_limb(visits).items():
        low_ms, high_ms = min(by_latency), max(by_latency)
        both = sorted(by_latency[low_ms].keys() & by_latency[high_ms].keys())
        if low_ms == high_ms or len(both) < 2:
            continue
        for measure in MEASURES:
            change = np.array(
                [
                    getattr(by_latency[high_ms][who], measure)
                    - getattr(by_latency[low_ms][who], measure)
                    for who in both
                ],
                dtype=np.float64,
            )
            half = _half_interval(change) or 0.0
            mean = float(change.mean())
            yield Change(limb, measure, len(both), mean, mean - half, mean + half)


def _by_limb(visits: Sequence[Visit]) -> dict[str, dict[float, dict[int, PhaseOutcome]]]:
    """Return the phases: limb -> latency -> person."""
    found: dict[str, dict[float, dict[int, PhaseOutcome]]] = {}
    for visit in visits:
        for phase in visit.phases:
            by_latency = found.setdefault(phase.limb, {})
            by_latency.setdefault(phase.latency_ms, {})[visit.number] = phase
    return found
