"""Tests of inserting many rows in few statements, on both databases."""

from typing import Any

import pytest
from sqlalchemy import event, select
from sqlalchemy.exc import IntegrityError

from app.features.record.telemetry.positions import TABLE
from app.rows import insert_rows
from tests.features.lab import Lab


def rows(lab: Lab, session_id: str, count: int, next_seq: int) -> list[dict[str, Any]]:
    """Return the stream positions of `count` epochs."""
    now = lab.context.clock.utc_now()
    numbers = dict.fromkeys(("produced", "frames_stored", "frames_flagged", "phase_id"), 3)
    return [
        {
            "epoch": epoch,  # in another order than the table's
            "stream": "target",
            "session_id": session_id,
            "next_seq": next_seq,
            "active_s": 0.1 * epoch,
            "abilities": ["hands"],
            "first_at": now,
            "last_at": now,
            **numbers,
        }
        for epoch in range(1, count + 1)
    ]


@pytest.mark.parametrize("count", [1, 2, 63, 64, 65, 200])
def test_every_row_is_stored_as_given(lab: Lab, count: int) -> None:
    """Any number of rows is stored as given, regardless of the order of their columns."""
    session_id = str(lab.join()["id"])
    given = rows(lab, session_id, count, 7)
    with lab.database.writing() as db:
        insert_rows(db, TABLE, given)
    of_session = select(TABLE).where(TABLE.c.session_id == session_id)
    with lab.database.reading() as db:
        stored = db.execute(of_session.order_by(TABLE.c.epoch)).mappings().all()
    assert [dict(row) for row in stored] == given


def test_existing_rows_are_updated_only_in_the_moving_columns(lab: Lab) -> None:
    """New rows are inserted; of existing ones only the columns in `moving` are updated."""
    session_id = str(lab.join()["id"])
    first, repeated = rows(lab, session_id, 3, 7), rows(lab, session_id, 5, 9)
    with lab.database.writing() as db:
        insert_rows(db, TABLE, first)
        insert_rows(db, TABLE, [{**row, "produced": 8} for row in repeated], moving=("next_seq",))
    columns = select(TABLE.c.next_seq, TABLE.c.produced).where(TABLE.c.session_id == session_id)
    with lab.database.reading() as db:
        found = db.execute(columns.order_by(TABLE.c.epoch)).all()
    assert found == [(9, 3)] * 3 + [(9, 8)] * 2


def test_inserting_an_existing_row_is_an_error(lab: Lab) -> None:
    """Inserting a row that exists is an error unless `moving` is given."""
    given = rows(lab, str(lab.join()["id"]), 2, 7)
    with pytest.raises(IntegrityError), lab.database.writing() as db:
        insert_rows(db, TABLE, [*given, given[0]])


def test_a_hundred_rows_need_few_statements(lab: Lab) -> None:
    """A hundred rows take three statements on SQLite (64 + 32 + 4) and one on PostgreSQL."""
    sent: list[int] = []
    given = rows(lab, str(lab.join()["id"]), 100, 7)

    def note(_connection: Any, _cursor: Any, _text: str, values: Any, *_: Any) -> None:
        sent.append(len(values) // len(given[0]))

    with lab.database.writing() as db:
        event.listen(db.connection(), "before_cursor_execute", note)
        insert_rows(db, TABLE, given)
    assert sent == ([64, 32, 4] if lab.database.is_sqlite else [1])
