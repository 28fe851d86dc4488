"""Tests that every change to the event log by SQL is detected."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

from sqlalchemy import Executable, delete, insert, select, update
from sqlalchemy.orm import Session

from app.features.record.receipts import receipt_of
from app.models import SessionEvent
from tests.faults.figures import note
from tests.features.lab import Lab

CHANGES: dict[str, Callable[[Any], Any]] = {
    "type": lambda _: "note_added",
    "payload": lambda text: text.replace("}", ',"more":1}') if text != "{}" else '{"more":1}',
    "actor": lambda _: "account:somebody",
    "command_id": lambda _: "00000000-0000-0000-0000-000000000000",
    "monotonic_ns": lambda number: number + 1,
    "previous_hash": lambda text: text[::-1] if text != text[::-1] else "1" * 64,
    "hash": lambda text: ("0" if text[0] != "0" else "1") + text[1:],
    "seq": lambda number: number + 1000,
}
Attack = Callable[[Session], object]


def attacks(rows: list[SessionEvent]) -> Iterator[Attack]:
    """Yield SQL that changes each column, removes each event, inserts one, or truncates the log."""
    table = SessionEvent.__table__
    for row in rows:
        here = (table.c.session_id == row.session_id, table.c.seq == row.seq)
        for column, change in CHANGES.items():
            value = change(getattr(row, column))
            if value != getattr(row, column):
                yield partial(_execute, update(SessionEvent).where(*here).values({column: value}))
        yield partial(_execute, delete(SessionEvent).where(*here))
    last = rows[-1]
    copy = {name: getattr(last, name) for name in table.c.keys()}  # noqa: SIM118 - a SQL collection
    yield partial(_execute, insert(SessionEvent).values({**copy, "seq": last.seq + 1}))


def _execute(statement: Executable, db: Session) -> None:
    db.execute(statement)


def test_every_change_of_the_log_is_found(lab: Lab) -> None:
    """The receipt reports the log as changed after any change by SQL."""
    view = lab.skip_to(lab.join(), "materialise")
    lab.command(view, "note", text="a note")
    session_id = view["id"]
    with lab.database.reading() as db:
        rows = list(
            db.scalars(
                select(SessionEvent)
                .where(SessionEvent.session_id == session_id)
                .order_by(SessionEvent.seq)
            )
        )
        assert receipt_of(db, session_id).chain_ok
    found = [_is_found(lab, session_id, attack) for attack in attacks(rows)]
    note(39, "event log edited in SQL", "found of tried", f"{sum(found)} of {len(found)}")
    assert len(found) > 50
    assert all(found)


def _is_found(lab: Lab, session_id: str, attack: Attack) -> bool:
    """Return whether an attack is detected; roll the attack back afterwards."""
    with lab.database.engine.connect() as connection:
        transaction = connection.begin()
        with Session(connection, join_transaction_mode="create_savepoint") as db:
            attack(db)
            db.expire_all()
            broken = not receipt_of(db, session_id).chain_ok
        transaction.rollback()
    return broken
