"""Decide whether a completed session is valid, by the rules of the study version it followed.

This is the only place where that is decided. It is decided when the session ends, and again when a
latency is measured later. The result is stored on the session (`shortfalls`), from where ledger,
dashboard, statistics, export and cockpit read it.
"""

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.design.studies import version_content
from app.features.record.ledger import Shortfall, ShortfallCode, settle_attempt
from app.features.record.sessions.engine import SessionState
from app.features.record.sessions.engine.state import PhaseState
from app.models import PhaseLatency, StudySession
from app.protocol import LatencyRule, Step, ValidWhen

MS_PER_S = 1000.0


@dataclass(frozen=True)
class PhaseDelay:
    """A phase's latencies in seconds; `achieved_s` is None if it could not be determined."""

    ordered_s: float
    achieved_s: float | None


def judged(
    rules: ValidWhen,
    plan: Sequence[Step],
    state: SessionState,
    delays: Mapping[int, PhaseDelay],
    doubted: Collection[int | None] = (),
    *,
    of_people: bool = True,
) -> tuple[Shortfall, ...]:
    """Return the shortfalls of a session in the order of its steps; none if it is valid.

    Args:
        rules: the rules of its study version.
        plan: its steps.
        state: its state.
        delays: by phase id. A phase that is missing here has not been measured yet, so its latency
            is not judged.
        doubted: ids of phases for which the headset reported something that cannot be true; None
            stands for the whole session.
        of_people: whether consent is required: not for a test, an expert's try or a simulation.
    """
    whole = [Shortfall(code="headset_doubtful", step="session")] if None in doubted else []
    if of_people:
        whole += _without_consent(plan, state)
    of_steps = (_of_step(rules, step, state, delays, doubted) for step in plan)
    return (*whole, *(found for of_step in of_steps for found in of_step))


def _without_consent(plan: Sequence[Step], state: SessionState) -> list[Shortfall]:
    """Return a shortfall for every consent of the study that was not given."""
    return [
        Shortfall(code="consent_skipped", step=step.key)
        for step in plan
        if step.kind == "consent" and state.steps[step.index].status != "done"
    ]


def _of_step(
    rules: ValidWhen,
    step: Step,
    state: SessionState,
    delays: Mapping[int, PhaseDelay],
    doubted: Collection[int | None],
) -> Iterator[Shortfall]:
    done = state.steps[step.index].status == "done"
    limb = None if step.limb is None else str(step.limb)
    if step.instrument is not None:
        if step.instrument in rules.forms and not done:
            yield Shortfall(
                code="form_skipped",
                step=step.key,
                block=step.block,
                phase=limb,
                instrument=step.instrument,
            )
        return
    rule = next((one for one in rules.phases if one.phase == step.phase_key), None)
    if rule is None:
        return
    runs = [one for one in state.ended_phases if one.step == step.index and one.status == "done"]
    found = (
        _of_phase(
            rules.achieved_latency,
            rule.least_s(step.duration_s or 0.0),
            runs[-1],
            delays.get(runs[-1].phase_id),
            doubtful=runs[-1].phase_id in doubted,
        )
        if done and runs
        else [Found("phase_skipped")]
    )
    for code, value, limit in found:
        yield Shortfall(
            code=code,
            step=step.key,
            block=step.block,
            phase=step.phase_key,
            value=value,
            limit=limit,
        )


class Found(NamedTuple):
    """A shortfall of a phase, without the phase."""

    code: ShortfallCode
    value: float | None = None
    limit: float | None = None


def _of_phase(
    latency: LatencyRule | None,
    min_s: float,
    run: PhaseState,
    delay: PhaseDelay | None,
    *,
    doubtful: bool,
) -> Iterator[Found]:
    """Yield the shortfalls of a phase that was finished."""
    if doubtful:
        yield Found("phase_doubtful")
    if run.active_s < min_s:
        yield Found("phase_short", run.active_s, min_s)
    if delay is None or latency is None:
        return
    if delay.achieved_s is None:
        if latency.reported:
            yield Found("latency_missing")
    elif latency.tolerance_ms is not None:
        off_ms = MS_PER_S * abs(delay.achieved_s - delay.ordered_s)
        if off_ms > latency.tolerance_ms:
            yield Found("latency_off", off_ms, latency.tolerance_ms)


def settle_validity(
    db: Session,
    session: StudySession,
    plan: Sequence[Step],
    state: SessionState,
    doubted: Collection[int | None] = (),
) -> None:
    """Decide whether a completed session is valid, and so whether it keeps its slot.

    `doubted` as for `judged`; the caller supplies it, since doubts are computed from the whole
    record. Nothing is decided for a session that is still running or was broken off, nor if the
    study has no rules.
    """
    rules = version_content(db, session.study_version_id).protocol.valid_when
    if rules is None or state.status != "completed" or state.erased:
        return
    delays, of_people = _delays(db, session.id), session.kind == "people"
    found = judged(rules, plan, state, delays, doubted, of_people=of_people)
    session.shortfalls = [one.model_dump() for one in found]
    settle_attempt(db, session, counts=not found)


def _delays(db: Session, session_id: str) -> dict[int, PhaseDelay]:
    rows = db.execute(
        select(PhaseLatency.phase_id, PhaseLatency.ordered_s, PhaseLatency.achieved_s).where(
            PhaseLatency.session_id == session_id
        )
    )
    return {phase_id: PhaseDelay(ordered_s, achieved_s) for phase_id, ordered_s, achieved_s in rows}
