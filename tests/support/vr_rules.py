"""What the server's task rules make of the inputs that a headset's page gave to its own.

The emulated headset's script notes every command of a phase's clock and every table of touches that
the page hands to its rules (`frontend/src/vr/testing/ruleLedger.ts`). `derived` hands the same to
the rules in Python; `stored` is what the page reported and the server keeps. Both must be equal to
the last bit.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.models import Completion, Contact
from app.protocol import Tasks
from app.rehearsal.task_run import BoxRun
from app.science.tasks import CommandKind, Laterality, Limb, TaskRules
from app.wire import CompletionReport, ContactReport, PhaseOrder, ReportBody

Json = dict[str, Any]
Row = tuple[object, ...]
Table = NDArray[np.bool_]


@dataclass
class Outcome:
    """The contacts and completions of a session, one row each, sorted."""

    contacts: list[Row] = field(default_factory=list)
    completions: list[Row] = field(default_factory=list)

    def sort(self) -> "Outcome":
        """Sort both, because reports of one instant may be stored in any order."""
        self.contacts.sort(key=repr)
        self.completions.sort(key=repr)
        return self


def derived(records: Sequence[Json], tasks: Tasks) -> Outcome:
    """Run the rules in Python on the inputs of all phases that the page has noted."""
    outcome = Outcome()
    for record in records:
        for report in _reports(record, tasks):
            match report:
                case ContactReport():
                    outcome.contacts.append(_contact(record["epoch"], report))
                case CompletionReport():
                    outcome.completions.append(_completion(record["epoch"], report))
    return outcome.sort()


def stored(db: Session, session_id: str) -> Outcome:
    """Read what the page reported from the session's record."""
    contacts = db.scalars(select(Contact).where(Contact.session_id == session_id))
    completions = db.scalars(select(Completion).where(Completion.session_id == session_id))
    return Outcome(
        [_contact(one.epoch, one) for one in contacts],
        [
            (
                one.epoch,
                one.phase_id,
                one.number,
                one.at_s,
                one.active_s,
                one.duration_s,
                tuple(one.order),
                one.out_of_order_touches,
            )
            for one in completions
        ],
    ).sort()


def _reports(record: Json, tasks: Tasks) -> list[ReportBody]:
    order = PhaseOrder.model_validate(record["order"])
    layout = tasks.layouts()[Limb(order.limb or "")]
    rules = TaskRules(layout, Laterality(record["writingHand"]))
    parts = tuple(record["parts"])
    run = BoxRun(order, rules, parts, 0.0)
    shape = len(layout.surfaces), len(parts)
    reports: list[ReportBody] = []
    for one in record["inputs"]:
        t_s = one["timeS"]
        if "command" in one:
            run.command(CommandKind(one["command"]), t_s)
        else:
            tables = _table(one["touched"], shape), _table(one["near"], shape)
            run.touch(t_s, partial(_same, tables))
        reports += run.news(t_s)
    return reports


def _same(tables: tuple[Table, Table]) -> tuple[Table, Table]:
    return tables


def _table(indices: Sequence[int], shape: tuple[int, int]) -> Table:
    table = np.zeros(shape, dtype=np.bool_)
    table.flat[list(indices)] = True
    return table


def _contact(epoch: int, one: Contact | ContactReport) -> Row:
    return (
        epoch,
        one.phase_id,
        one.surface,
        one.body_part,
        one.begin_s,
        one.end_s,
        one.begin_active_s,
        one.end_active_s,
        one.effect,
    )


def _completion(epoch: int, one: CompletionReport) -> Row:
    return (
        epoch,
        one.phase_id,
        one.number,
        one.t_s,
        one.active_s,
        one.duration_s,
        tuple(one.order),
        one.out_of_order_touches,
    )
