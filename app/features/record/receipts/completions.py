"""Rerun the task rules on the stored contacts, and compare with the stored completions."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.headset import participant_info
from app.features.record.sessions import protocol_of_session
from app.models import ClientReport, Completion, Contact, Phase, StudySession
from app.protocol import BOX_KINDS, COUNTED_KINDS
from app.science.tasks import (
    Command,
    CommandKind,
    ContactInterval,
    Laterality,
    TaskRuleError,
    TaskRules,
    rederive,
)

_COMMANDS = {
    "started": CommandKind.START,
    "paused": CommandKind.PAUSE,
    "resumed": CommandKind.RESUME,
    "time_up": CommandKind.FREEZE,
}
_COUNTED = tuple(kind for kind in COUNTED_KINDS if kind in BOX_KINDS)
Found = tuple[int, float, float, int]
"""A completion: its number, time and duration (s, client clock), and contacts out of order."""


@dataclass(frozen=True)
class CompletionReceipt:
    """The number of completions stored for a task phase, and the number derived from contacts.

    `agree`: the same numbers at the same times, with the same durations; otherwise `reason` says
    what differs.
    """

    phase_id: int
    stored: int
    rederived: int
    agree: bool
    reason: str | None


def completion_receipts(db: Session, session: StudySession) -> tuple[CompletionReceipt, ...]:
    """Return a receipt for every task phase that was finished."""
    phases = db.scalars(
        select(Phase)
        .where(Phase.session_id == session.id, Phase.kind.in_(_COUNTED), Phase.status == "done")
        .order_by(Phase.phase_id)
    ).all()
    return tuple(_phase_receipt(db, session, phase) for phase in phases)


def _phase_receipt(db: Session, session: StudySession, phase: Phase) -> CompletionReceipt:
    stored: list[Found] = [
        (row.number, row.at_s, row.duration_s, row.out_of_order_touches)
        for row in db.scalars(
            select(Completion)
            .where(Completion.session_id == session.id, Completion.phase_id == phase.phase_id)
            .order_by(Completion.number)
        )
    ]
    try:
        derived = _derive(db, session, phase)
    except TaskRuleError as error:
        return CompletionReceipt(phase.phase_id, len(stored), 0, agree=False, reason=str(error))
    reason = _difference(stored, derived)
    return CompletionReceipt(
        phase.phase_id, len(stored), len(derived), agree=reason is None, reason=reason
    )


def _difference(stored: Sequence[Found], derived: Sequence[Found]) -> str | None:
    if len(stored) != len(derived):
        return f"{len(stored)} completions are stored, {len(derived)} follow from the contacts"
    for one, other in zip(stored, derived, strict=True):
        if one != other:
            return f"completion {one[0]} is stored as {one[1:]}, the contacts give {other[1:]}"
    return None


def _derive(db: Session, session: StudySession, phase: Phase) -> list[Found]:
    """Derive the completions of a phase from its contacts, numbered across all epochs."""
    rules = _rules(db, session, phase)
    found: list[Found] = []
    for epoch, commands in _commands_by_epoch(db, phase):
        initial, before = rules.initial(), len(found)
        if rules.layout.reverse_after_task and before % 2:
            # An epoch that takes over starts with the order reversed as the previous epoch left it.
            initial = replace(initial, order=initial.order[::-1])
        done = rederive(rules, _intervals(db, phase, epoch), commands, initial=initial)
        found += [
            (before + one.number, one.completed_s, one.duration_s, one.out_of_order) for one in done
        ]
    return found


def _rules(db: Session, session: StudySession, phase: Phase) -> TaskRules:
    tasks = protocol_of_session(db, session).tasks
    layout = tasks.layout(phase.limb or "hand")
    return TaskRules(layout, Laterality(participant_info(db, session).handedness or "right"))


def _commands_by_epoch(db: Session, phase: Phase) -> list[tuple[int, list[Command]]]:
    """Return, for each epoch, the clock commands that the headset reported, accepted or not."""
    rows = db.execute(
        select(ClientReport.epoch, ClientReport.payload)
        .where(ClientReport.session_id == phase.session_id, ClientReport.type == "phase")
        .order_by(ClientReport.epoch, ClientReport.seq)
    )
    commands: dict[int, list[Command]] = {}
    for epoch, payload in rows:
        kind = _COMMANDS.get(payload["what"])
        if payload["phase_id"] == phase.phase_id and kind is not None:
            commands.setdefault(epoch, []).append(Command(kind, payload["t_s"]))
    return [(epoch, _from_the_start(reported)) for epoch, reported in commands.items()]


def _from_the_start(reported: list[Command]) -> list[Command]:
    """Return the commands of an epoch, beginning with a start command.

    An epoch that took over began with a stopped clock, and continues at its first resume.
    """
    if reported[0].kind is CommandKind.START:
        return reported
    resumed = [command for command in reported if command.kind is CommandKind.RESUME]
    if not resumed:
        return []
    taken_over = Command(CommandKind.START, resumed[0].time_s)
    at = reported.index(resumed[0])
    return [taken_over, replace(taken_over, kind=CommandKind.PAUSE), *reported[at:]]


def _intervals(db: Session, phase: Phase, epoch: int) -> list[ContactInterval]:
    rows = db.scalars(
        select(Contact)
        .where(
            Contact.session_id == phase.session_id,
            Contact.phase_id == phase.phase_id,
            Contact.epoch == epoch,
        )
        .order_by(Contact.end_s, Contact.id)
    )
    return [interval_of(row) for row in rows]


def interval_of(row: Contact) -> ContactInterval:
    """Return a stored contact as the task rules see it."""
    return ContactInterval(
        row.surface, row.body_part, row.begin_s, row.end_s, row.begin_active_s, row.end_active_s
    )
