"""Store a headset's reports and act on them; a rejected report is stored with the reason."""

from datetime import datetime
from typing import Any, cast

from sqlalchemy import Table, func, select
from sqlalchemy.orm import Session

from app.errors import ReembodyError
from app.features.record.alarms import Change, Condition, store_change
from app.features.record.sessions import (
    AVATAR_CHANGE,
    CALIBRATION,
    AskToStop,
    CloseStop,
    ContentRef,
    Materialise,
    Report,
    ReportAvatarChange,
    ReportCalibration,
    apply_command,
    state_of,
    store_content,
)
from app.features.record.telemetry.ingest import Intake
from app.features.record.telemetry.positions import Outcome
from app.models import ClientReport, Completion, Contact, new_id
from app.platform.access import session_by_id
from app.platform.context import AppContext
from app.wire import (
    REPORT_STREAM,
    AddedLatencyReport,
    AvatarChangeReport,
    CalibrationReport,
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
        if isinstance(body, ContactReport):
            # By far the most frequent report; it changes no state, so it is inserted with the
            # others.
            values = body.model_dump(exclude={"kind"})
            own = {"id": new_id(), "session_id": session_id, "epoch": message.epoch}
            intake.gather(CONTACTS, {**own, **values})
        elif isinstance(body, GoalsReport):
            # It changes no state; pages show it, and the pre-flight check judges it.
            intake.context.hub.publish_after_commit(intake.db, session_id)
        elif not isinstance(body, AddedLatencyReport):
            # Carrying out a report reads the tables, so earlier messages must be written first.
            intake.flush()
            with intake.db.begin_nested():
                _act(intake, session_id, message, outcome)
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
            _act_on_calibration(db, intake.context, session_id, body)
        case CallReport():
            _act_on_call(db, intake.context, session_id, body)
        case CompletionReport():
            _require_new(db, session_id, body)
            db.add(_completion(session_id, message.epoch, body))


def _act_on_avatar_change(
    db: Session, context: AppContext, session_id: str, body: AvatarChangeReport
) -> None:
    session = session_by_id(db, session_id, lock=True)
    content: ContentRef | None = None
    if body.held_rad or body.problem:
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


def _act_on_calibration(
    db: Session, context: AppContext, session_id: str, body: CalibrationReport
) -> None:
    session = session_by_id(db, session_id, lock=True)
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


def _act_on_call(db: Session, context: AppContext, session_id: str, body: CallReport) -> None:
    """Act on a call from inside the headset; one that is taken back was either of the two."""
    session = session_by_id(db, session_id, lock=True)
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


def _require_new(db: Session, session_id: str, body: CompletionReport) -> None:
    if db.get(Completion, (session_id, body.phase_id, body.number)) is not None:
        raise ReembodyError(
            f"completion {body.number} of phase {body.phase_id} was reported before",
            value=body.number,
            remedy="Count on from the completions in the newest state message.",
        )
