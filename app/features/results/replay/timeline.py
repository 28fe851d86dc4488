"""Collect what happened in a phase, in the phase's time."""

import json
from collections.abc import Iterator

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.headset import worn_humanoid
from app.features.record.questionnaires import stored_scores
from app.features.record.sessions import (
    content_body,
    contents_of,
    events_of,
    plan_of,
    protocol_of_session,
)
from app.features.results.replay.avatar_settings import avatar_settings
from app.features.results.replay.clock import PhaseClock
from app.features.results.replay.schemas import (
    ActiveStretch,
    ClientRun,
    Moment,
    Replay,
    ReplayCompletion,
    ReplayContact,
    ReplayNote,
    ReplaySurface,
)
from app.features.results.replay.service import (
    USUAL_STATURE_M,
    Replayable,
    body_of,
    frames_stored,
)
from app.features.results.replay.times import clock_reports_of, phase_clock
from app.models import Completion, Contact, Phase, Submission
from app.protocol import TIMED_KINDS


def replay_of(db: Session, phase_view: Replayable) -> Replay:
    """Return everything of a replay except the movement."""
    session, phase = phase_view.session, phase_view.phase
    clock = phase_clock(db, session, phase)
    stature_m = body_of(db, session, phase, full=phase_view.full).stature_m
    administrations = _administrations(db, phase_view)
    scores = [one for one in stored_scores(db, session) if one.administration in administrations]
    return Replay(
        session_id=session.id,
        phase_id=phase.phase_id,
        step_index=phase.step_index,
        attempt=phase.attempt,
        kind=phase.kind,
        limb=phase.limb,
        status=phase.status,
        view=phase_view.view,
        latency_ms=phase.latency_ms if phase_view.full else None,
        body=phase.body if phase_view.full else None,
        duration_s=clock.duration_s,
        active_s=phase.active_s,
        time_scale=session.time_scale,
        stature_m=stature_m or USUAL_STATURE_M,
        stature_known=stature_m is not None,
        humanoid=worn_humanoid(db, session, phase.body) if phase_view.full else None,
        avatar_settings=(avatar_settings(db, session, phase, clock) if phase_view.full else []),
        has_movement=frames_stored(db, phase) > 0,
        runs=[ClientRun(**vars(run)) for run in clock.runs],
        active=[ActiveStretch(**vars(one)) for one in clock.active],
        contacts=_contacts(db, phase, clock) if phase_view.full else [],
        completions=_completions(db, phase, clock) if phase_view.full else [],
        moments=sorted(_moments(db, phase, clock), key=lambda one: one.t_s),
        notes=list(_notes(db, phase, clock)),
        surfaces=_surfaces(db, phase_view) if phase_view.full else [],
        administrations=administrations,
        forms=scores,
    )


def _contacts(db: Session, phase: Phase, clock: PhaseClock) -> list[ReplayContact]:
    rows = db.scalars(
        select(Contact)
        .where(Contact.session_id == phase.session_id, Contact.phase_id == phase.phase_id)
        .order_by(Contact.begin_active_s, Contact.surface, Contact.body_part)
    )
    return [
        ReplayContact(
            surface=row.surface,
            surface_kind=row.surface_kind,
            box=row.box,
            body_part=row.body_part,
            effect=row.effect,
            begin_s=clock.of_counted(row.begin_active_s, row.epoch, row.begin_s),
            end_s=clock.of_counted(row.end_active_s, row.epoch, row.end_s),
            begin_active_s=row.begin_active_s,
            end_active_s=row.end_active_s,
        )
        for row in rows
    ]


def _completions(db: Session, phase: Phase, clock: PhaseClock) -> list[ReplayCompletion]:
    rows = db.scalars(
        select(Completion)
        .where(Completion.session_id == phase.session_id, Completion.phase_id == phase.phase_id)
        .order_by(Completion.number)
    )
    return [
        ReplayCompletion(
            number=row.number,
            t_s=clock.of_counted(row.active_s, row.epoch, row.at_s),
            active_s=row.active_s,
            duration_s=row.duration_s,
            out_of_order_touches=row.out_of_order_touches,
        )
        for row in rows
    ]


def _moments(db: Session, phase: Phase, clock: PhaseClock) -> Iterator[Moment]:
    """Yield the changes of the phase's clock as the headset reported or the server assumed them."""
    for one in clock_reports_of(db, phase):
        t_s = one.client_s + clock.offsets_s[one.epoch]
        cause = one.cause if one.what == "paused" else None
        yield Moment(what=one.what, t_s=t_s, active_s=one.active_s, cause=cause)
    for row in events_of(db, phase.session_id):
        payload = json.loads(row.payload)
        if payload.get("phase_id") != phase.phase_id:
            continue
        if row.type == "phase_paused" and payload.get("client_t_s") is None:
            t_s = clock.of_active(payload["active_s"], later=False)
            yield Moment(
                what="paused", t_s=t_s, active_s=payload["active_s"], cause=payload.get("cause")
            )
        elif row.type == "phase_voided":
            yield Moment(
                what="voided",
                t_s=clock.duration_s,
                active_s=phase.active_s,
                cause=payload.get("cause"),
            )


def _notes(db: Session, phase: Phase, clock: PhaseClock) -> Iterator[ReplayNote]:
    """Yield the notes that were written while the phase ran or was paused."""
    for row in contents_of(db, phase.session_id, "note"):
        if row.body is None or phase.started_at is None or row.created_at < phase.started_at:
            continue
        t_s = clock.of_utc(row.created_at)
        if (
            t_s is None
            or t_s > clock.duration_s
            or (phase.ended_at or row.created_at) < row.created_at
        ):
            continue
        yield ReplayNote(
            id=row.id,
            text=str(content_body(row)),
            by=row.created_by,
            at=row.created_at,
            t_s=max(0.0, t_s),
        )


def _surfaces(db: Session, phase_view: Replayable) -> list[ReplaySurface]:
    limb = phase_view.phase.limb
    if limb is None:
        return []
    tasks = protocol_of_session(db, phase_view.session).tasks
    layout = tasks.layout(limb)
    return [
        ReplaySurface(
            key=one.key,
            kind=str(one.kind),
            box=one.box,
            center_m=one.center_m,
            half_size_m=one.half_size_m,
        )
        for one in layout.surfaces
    ]


def _administrations(db: Session, phase_view: Replayable) -> list[str]:
    """Return the forms of this attempt between this phase and the next phase of the procedure."""
    phase, plan = phase_view.phase, plan_of(db, phase_view.session)
    following = []
    for step in plan[phase.step_index + 1 :]:
        if step.kind in TIMED_KINDS:
            break
        following.append(step.index)
    repeated_at = db.scalar(
        select(Phase.prepared_at)
        .where(
            Phase.session_id == phase.session_id,
            Phase.step_index == phase.step_index,
            Phase.attempt > phase.attempt,
        )
        .order_by(Phase.attempt)
        .limit(1)
    )
    filled = select(Submission.step_index, Submission.administration).where(
        Submission.session_id == phase.session_id,
        Submission.step_index.in_(following),
        Submission.submitted_at >= phase.prepared_at,
    )
    if repeated_at is not None:
        filled = filled.where(Submission.submitted_at < repeated_at)
    # If a form was filled in twice, the later one counts.
    newest = dict(db.execute(filled.order_by(Submission.submitted_at)).all())
    return [newest[index] for index in following if index in newest]
