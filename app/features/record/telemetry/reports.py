"""Store a headset's reports and act on them; a rejected report is stored with the reason."""

import math
from datetime import datetime, timedelta
from typing import Any, cast

from sqlalchemy import Table, func, select
from sqlalchemy.orm import Session

from app.errors import ReembodyError
from app.features.record.alarms import Change, Condition, store_change
from app.features.record.doubts import exceeds_possible
from app.features.record.sessions import (
    AVATAR_CHANGE,
    CALIBRATION,
    AskToStop,
    CloseStop,
    Materialise,
    Report,
    ReportAvatarChange,
    ReportCalibration,
    apply_command,
    avatar_in_force,
    state_of,
    store_content,
)
from app.features.record.telemetry.ingest import Intake
from app.features.record.telemetry.positions import Outcome
from app.models import (
    AlarmRow,
    ClientReport,
    Completion,
    Contact,
    Phase,
    StudySession,
    TelemetryStream,
    new_id,
)
from app.platform.access import session_by_id
from app.platform.context import AppContext
from app.science.avatar.body import SEGMENT_NAMES
from app.wire import (
    REPORT_STREAM,
    AddedLatencyReport,
    AvatarChangeReport,
    CalibrationReport,
    CalibrationStepReport,
    CallReport,
    CompletionReport,
    ContactReport,
    GoalsReport,
    MaterialisedReport,
    PhaseReport,
    RefusedReport,
    Resend,
)
from app.wire import Report as ReportMessage

REPORTS = cast("Table", ClientReport.__table__)
CONTACTS = cast("Table", Contact.__table__)
POSSIBLE_M = {"span_m": (0.3, 3.0), "eye_height_m": (0.3, 2.6)}
"""What a calibration can have measured of a person, beside the stature, which its type bounds."""
POSSIBLE_EYES = (0.75, 0.99)
"""Height of the eyes of somebody who stands, as a share of the stature; usual is .91 to .95."""
WITHIN_REACH_M = 1.0
"""What tracks a part of the body is worn on it: its joint and its residual are not farther off."""
ROTATION_TOLERANCE = 1e-3
TAKEN_BACK_AT_MOST, REPEATED_WITHIN = 3, timedelta(minutes=1)
"""How many calls a participant may take back in a while; the next one stays open."""
COMPENSATION_MS = 1.0
"""By how much reported seconds may differ from ordered milliseconds."""


def store_report(intake: Intake, session_id: str, message: ReportMessage, outcome: Outcome) -> None:
    """Store a report and act on it; a rejected report is stored with the reason."""
    at = intake.positions.at(session_id, REPORT_STREAM, message.epoch)
    if message.seq > at.next_seq:
        at.claimed(message.seq + 1)
        outcome.notices.append(Resend(**at.as_message.model_dump()))
        return
    if message.seq == at.next_seq:
        refusal = _take(intake, session_id, message, outcome)
        intake.gather(REPORTS, _row(session_id, message, refusal, intake.now))
        at.stored(1)
        if refusal is not None:
            outcome.notices.append(
                RefusedReport(
                    epoch=message.epoch,
                    seq=message.seq,
                    message=refusal.message,
                    remedy=refusal.remedy,
                )
            )
    outcome.stored_up_to(at)


def _row(
    session_id: str, message: ReportMessage, refusal: ReembodyError | None, now: datetime
) -> dict[str, Any]:
    return {
        "session_id": session_id,
        "epoch": message.epoch,
        "seq": message.seq,
        "type": message.body.kind,
        "payload": message.body.model_dump(),
        "accepted": refusal is None,
        "refusal": None if refusal is None else refusal.message[:400],
        "received_at": now,
    }


def _take(
    intake: Intake, session_id: str, message: ReportMessage, outcome: Outcome
) -> ReembodyError | None:
    """Carry out a report; return the error if it is rejected."""
    body = message.body
    try:
        if isinstance(body, ContactReport | CompletionReport | AddedLatencyReport):
            _require_phase(intake, session_id, body.phase_id)
        if isinstance(body, AddedLatencyReport):
            _require_ordered(intake, session_id, body)
        if isinstance(body, GoalsReport):
            _require_onwards(intake, session_id, message.epoch, body)
        if isinstance(body, ContactReport):
            # By far the most frequent report; it changes no state, so it is inserted with the
            # others.
            values = body.model_dump(exclude={"kind"})
            own = {"id": new_id(), "session_id": session_id, "epoch": message.epoch}
            intake.gather(CONTACTS, {**own, **values})
        elif isinstance(body, GoalsReport | CalibrationStepReport):
            # They change no state; pages show them, and the pre-flight check judges the goals.
            intake.context.hub.publish_after_commit(intake.db, session_id)
        elif not isinstance(body, AddedLatencyReport):
            # Carrying out a report reads the tables, so earlier messages must be written first.
            intake.flush()
            with intake.db.begin_nested():
                _act(intake, session_id, message, outcome)
            outcome.changed_state = True
    except ReembodyError as refusal:
        return refusal
    return None


def _act(intake: Intake, session_id: str, message: ReportMessage, outcome: Outcome) -> None:
    db, body = intake.db, message.body
    match body:
        case PhaseReport():
            _act_on_phase(db, intake.context, session_id, body, outcome)
        case MaterialisedReport():
            session = session_by_id(db, session_id, lock=True)
            # The report itself shows that a headset is connected, or was, if it comes from the
            # journal.
            command = Materialise(by="headset", client_t_s=body.t_s, headset_connected=True)
            apply_command(db, intake.context, session, command, actor="headset")
        case AvatarChangeReport():
            _act_on_avatar_change(db, intake.context, session_id, body)
        case CalibrationReport():
            _act_on_calibration(db, intake.context, session_id, message.epoch, body)
        case CallReport():
            _act_on_call(db, intake.context, session_id, body)
        case CompletionReport():
            _require_new(db, session_id, body)
            db.add(_completion(session_id, message.epoch, body))


def _act_on_avatar_change(
    db: Session, context: AppContext, session_id: str, body: AvatarChangeReport
) -> None:
    session = session_by_id(db, session_id, lock=True)
    _require_consistent(db, session, body)
    before = state_of(session).avatar_changes
    if before is not None and before.applied and before.reported == body.revision and body.applied:
        # Carried out already. An event for each body that takes the changes over would tell when
        # the body changes.
        return
    # Every report has content, also without angles: a body that lacks the part has none.
    content = store_content(
        db,
        session_id=session_id,
        kind=AVATAR_CHANGE,
        body={"held_rad": body.held_rad, "problem": body.problem},
        by="headset",
        now=context.clock.utc_now(),
    )
    command = ReportAvatarChange(
        revision=body.revision, applied=body.applied, client_t_s=body.t_s, content=content
    )
    apply_command(db, context, session, command, actor="headset")


def _require_consistent(db: Session, session: StudySession, body: AvatarChangeReport) -> None:
    """Raise ReembodyError for a report that contradicts itself or the changes it answers."""
    if body.applied and body.problem is not None:
        raise ReembodyError(
            "the changes cannot have been applied and have failed",
            value={"applied": True, "problem": body.problem},
            valid=[{"applied": True, "problem": None}, {"applied": False, "problem": "the reason"}],
            remedy="Report what was achieved: the problem only with applied: false.",
        )
    in_force = avatar_in_force(db, session)
    if in_force is None:
        return
    is_current = body.revision == in_force.revision
    known = in_force.settings.held_rad if is_current else in_force.configured.axes
    unknown = sorted(body.held_rad.keys() - known)
    if unknown:
        raise ReembodyError(
            f"no cast of revision {body.revision} holds the axis {unknown[0]}",
            value=unknown,
            valid=sorted(known),
            remedy="Report the angles of the axes in held_rad of the state's avatar_changes.",
        )


def _act_on_calibration(
    db: Session, context: AppContext, session_id: str, epoch: int, body: CalibrationReport
) -> None:
    session = session_by_id(db, session_id, lock=True)
    _require_in_time(db, session, epoch)
    _require_possible(body)
    _require_worn(body)
    content = store_content(
        db,
        session_id=session_id,
        kind=CALIBRATION,
        body=body.model_dump(exclude={"kind", "t_s", "revision"}),
        by="headset",
        now=context.clock.utc_now(),
    )
    command = ReportCalibration(
        cause=body.cause, client_t_s=body.t_s, content=content, revision=body.revision
    )
    apply_command(db, context, session, command, actor="headset")


def _require_possible(body: CalibrationReport) -> None:
    """Raise ReembodyError if a calibration measured what no participant has."""
    measured = {name: getattr(body, name) for name in POSSIBLE_M}
    for name, length_m in measured.items():
        low_m, high_m = POSSIBLE_M[name]
        if length_m is not None and not low_m <= length_m <= high_m:
            raise ReembodyError(
                f"{name} {length_m:g} is not that of a person",
                value=length_m,
                valid=[low_m, high_m],
                remedy="Let the participant stand up straight, and calibrate again.",
            )
    if body.eye_height_m is not None:
        low_m, high_m = (share * body.stature_m for share in POSSIBLE_EYES)
        if not low_m <= body.eye_height_m <= high_m:
            raise ReembodyError(
                f"eyes at {body.eye_height_m:g} m do not fit a stature of {body.stature_m:g} m",
                value=body.eye_height_m,
                valid=[low_m, high_m],
                remedy="Check the participant's stature, let them stand up straight, and calibrate"
                " again.",
            )
    for name, length_m in body.segments_m.items():
        if name not in SEGMENT_NAMES or not 0.0 < length_m < body.stature_m:
            raise ReembodyError(
                f"segments_m.{name} {length_m:g} is no length of a segment of the body",
                value={name: length_m},
                valid=list(SEGMENT_NAMES),
                remedy="Report lengths in metres, above 0 and below the stature.",
            )


def _require_worn(body: CalibrationReport) -> None:
    """Raise ReembodyError if what tracks a part is not on the body, or is turned by no rotation."""
    for goal, residual_m in body.residuals_m.items():
        if residual_m > WITHIN_REACH_M:
            raise ReembodyError(
                f"residuals_m.{goal} {residual_m:g} is farther than a body reaches",
                value=residual_m,
                valid=[0.0, WITHIN_REACH_M],
                remedy="Look what tracks this part, and calibrate again.",
            )
    for goal, pose in body.tracker_from_goal.items():
        distance_m = math.hypot(*pose.position_m)
        if distance_m > WITHIN_REACH_M:
            raise ReembodyError(
                f"tracker_from_goal.{goal} is {distance_m:g} m from what tracks it",
                value=list(pose.position_m),
                valid=f"at most {WITHIN_REACH_M:g} m",
                remedy="Look what tracks this part, and calibrate again.",
            )
        if abs(math.hypot(*pose.rotation) - 1.0) > ROTATION_TOLERANCE:
            raise ReembodyError(
                f"tracker_from_goal.{goal}.rotation is not a rotation",
                value=list(pose.rotation),
                valid="w, x, y, z of length 1",
                remedy="Report a quaternion of unit length, and calibrate again.",
            )


def _require_in_time(db: Session, session: StudySession, epoch: int) -> None:
    """Raise ReembodyError if a run calibrates that began after the session had ended.

    The journal of a run that began earlier may still bring what that run measured.
    """
    run = db.get(TelemetryStream, (session.id, REPORT_STREAM, epoch))
    if session.ended_at is not None and run is not None and run.first_at > session.ended_at:
        raise ReembodyError(
            "the session had ended before this run of the headset began, so it measured nobody",
            value=session.status,
            valid=["planned", "active"],
            remedy="Pair the headset with a session that is running.",
        )


def _act_on_call(db: Session, context: AppContext, session_id: str, body: CallReport) -> None:
    """Act on a call from inside the headset; one that is taken back was either of the two."""
    session = session_by_id(db, session_id, lock=True)
    if body.what == "taken_back":
        _require_patience(db, session_id, context.clock.utc_now())
    if body.what == "stop":
        apply_command(db, context, session, AskToStop(client_t_s=body.t_s), actor="headset")
        return
    if body.what == "taken_back":
        closed = CloseStop(outcome="taken_back")
        apply_command(db, context, session, closed, actor="headset")
    asked = body.what == "help"
    if asked and state_of(session).status not in ("planned", "active"):
        return
    words = (
        "The participant called the experimenter from inside the headset."
        if asked
        else "The participant no longer needs help."
    )
    change = Change(
        "raised" if asked else "cleared", Condition("help_asked", words), context.clock.utc_now()
    )
    if store_change(db, session_id, change):
        context.hub.publish_after_commit(db, session_id)


def _require_patience(db: Session, session_id: str, now: datetime) -> None:
    """Raise ReembodyError if the participant has called and taken back several times just now.

    The last call then stays open until somebody has come: no call is ever ignored, and nobody fills
    the record with calls.
    """
    since = now - REPEATED_WITHIN
    alarms = select(func.count()).where(
        AlarmRow.session_id == session_id,
        AlarmRow.code.in_(("help_asked", "stop_asked")),
        AlarmRow.state == "cleared",
        AlarmRow.at > since,
    )
    if (db.scalar(alarms) or 0) >= TAKEN_BACK_AT_MOST:
        raise ReembodyError(
            "the participant called several times within a minute, so the last call stays open",
            value="taken_back",
            valid=["stop", "help"],
            remedy="Show that somebody will come; the experimenter closes the call.",
        )


def _act_on_phase(
    db: Session, context: AppContext, session_id: str, body: PhaseReport, outcome: Outcome
) -> None:
    session = session_by_id(db, session_id, lock=True)
    command = Report(
        what=body.what,
        phase_id=body.phase_id,
        client_t_s=body.t_s,
        active_s=body.active_s,
        cause=body.cause,
        completions=_completions(db, session_id, body.phase_id) if body.what == "time_up" else 0,
    )
    apply_command(db, context, session, command, actor="headset")
    if body.what == "ended":
        outcome.phases_ended.append(body.phase_id)


def _completions(db: Session, session_id: str, phase_id: int) -> int:
    count = select(func.count()).select_from(Completion)
    of_phase = count.where(Completion.session_id == session_id, Completion.phase_id == phase_id)
    return db.scalar(of_phase) or 0


def _completion(session_id: str, epoch: int, body: CompletionReport) -> Completion:
    return Completion(
        session_id=session_id,
        epoch=epoch,
        phase_id=body.phase_id,
        number=body.number,
        at_s=body.t_s,
        active_s=body.active_s,
        duration_s=body.duration_s,
        order=list(body.order),
        out_of_order_touches=body.out_of_order_touches,
    )


def _require_phase(intake: Intake, session_id: str, phase_id: int) -> None:
    if not intake.has_phase(session_id, phase_id):
        raise ReembodyError(
            f"there is no phase {phase_id}",
            value=phase_id,
            remedy="Use the phase_id of the newest state message.",
        )


def _require_ordered(intake: Intake, session_id: str, body: AddedLatencyReport) -> None:
    """Raise ReembodyError if more was taken off the delay than was ordered in the phase."""
    ordered_ms = intake.db.get_one(Phase, (session_id, body.phase_id)).latency_ms
    if 1000.0 * body.compensated_s > ordered_ms + COMPENSATION_MS:
        raise ReembodyError(
            f"{1000.0 * body.compensated_s:g} ms cannot be taken off the {ordered_ms:g} ms that "
            f"phase {body.phase_id} orders",
            value=body.compensated_s,
            valid=[0.0, ordered_ms / 1000.0],
            remedy="Take off at most latency_ms of the phase, nothing where it is 0, and report "
            "what was taken off.",
        )


def _require_onwards(intake: Intake, session_id: str, epoch: int, body: GoalsReport) -> None:
    """Raise ReembodyError if goals are reported from a frame on that the run cannot have reached.

    Goals apply from one report to the next, so a report of earlier frames contradicts the last one.
    """
    intake.flush()
    newest = intake.db.scalar(
        select(ClientReport.payload)
        .where(
            ClientReport.session_id == session_id,
            ClientReport.epoch == epoch,
            ClientReport.type == "goals",
            ClientReport.accepted,
        )
        .order_by(ClientReport.seq.desc())
        .limit(1)
    )
    first = 0 if newest is None else int(newest["frame_seq"])
    if body.frame_seq < first:
        raise ReembodyError(
            f"the goals from frame {first} on are reported already",
            value=body.frame_seq,
            valid=[first],
            remedy="Report goals in the order of the frames, each before its first frame.",
        )
    age_s = intake.positions.at(session_id, REPORT_STREAM, epoch).age_s
    if exceeds_possible(body.frame_seq, age_s, session_by_id(intake.db, session_id).time_scale):
        raise ReembodyError(
            f"no run makes {body.frame_seq} frames in {age_s:.0f} s",
            value=body.frame_seq,
            valid="the seq of a frame of this run",
            remedy="Report the seq of the first frame to which the goals apply.",
        )


def _require_new(db: Session, session_id: str, body: CompletionReport) -> None:
    if db.get(Completion, (session_id, body.phase_id, body.number)) is not None:
        raise ReembodyError(
            f"completion {body.number} of phase {body.phase_id} was reported before",
            value=body.number,
            remedy="Count on from the completions in the newest state message.",
        )
