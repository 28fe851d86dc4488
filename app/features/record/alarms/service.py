"""Store and query alarms. Rows are only appended: one when raised, one when cleared."""

import math
from collections.abc import Collection, Iterable
from datetime import datetime, timedelta
from typing import Literal

from pydantic import BaseModel
from sqlalchemy import Select, bindparam, case, func, select
from sqlalchemy.orm import Session

from app.features.record.alarms.alarm import Change, Condition
from app.models import AlarmRow, StudySession

MESSAGE_LENGTH = 400
TICK = timedelta(microseconds=1)


class AlarmView(BaseModel):
    """An alarm of a session; `cleared_at` is null while it is open.

    `value` with its `unit` quantifies it at the time it was raised, and `client_t_s` is that time
    on the headset's clock. `outcome` says why it was cleared, unless its cause simply ceased.
    """

    id: str
    code: str
    severity: Literal["info", "warning", "critical"]
    stream: str | None
    message: str
    value: float | None
    unit: str | None
    client_t_s: float | None
    since: datetime
    cleared_at: datetime | None
    outcome: str | None


_NEWEST_FIRST = (
    select(AlarmRow)
    .where(AlarmRow.session_id == bindparam("session_id"))
    .order_by(AlarmRow.at.desc())
)


def store_change(db: Session, session_id: str, change: Change) -> bool:
    """Store the raising or clearing of an alarm; return False if it changes nothing.

    Two sockets of one session may raise the same alarm, and a session that ends clears them all.
    """
    condition = change.condition
    newest = db.scalars(
        _rows(session_id).where(
            AlarmRow.code == condition.code, AlarmRow.stream.is_not_distinct_from(condition.stream)
        )
    ).first()
    if (newest is not None and newest.state == "raised") == (change.state == "raised"):
        return False
    # The wall clock may have been set back, but an alarm's rows must stay in order.
    at = change.at if newest is None else max(change.at, newest.at + TICK)
    _add(db, session_id, condition, change.state, at)
    return True


def clear_all(
    db: Session,
    session_ids: Iterable[str],
    message: str,
    now: datetime,
    *,
    keep: Collection[str] = (),
) -> int:
    """Clear the open alarms of these sessions except the codes in `keep`; return how many.

    `message` is stored as the reason.
    """
    count = 0
    for session_id in session_ids:
        for row in open_rows(db, session_id):
            if row.code in keep:
                continue
            condition = Condition(row.code, message, row.stream)
            _add(db, session_id, condition, "cleared", max(now, row.at + TICK))
            count += 1
    return count


def sessions_with_open_alarms(db: Session) -> list[str]:
    """Return the ids of the sessions that have an open alarm."""
    balance = func.sum(case((AlarmRow.state == "raised", 1), else_=-1))
    query = (
        select(AlarmRow.session_id)
        .group_by(AlarmRow.session_id, AlarmRow.code, AlarmRow.stream)
        .having(balance > 0)
    )
    return sorted(set(db.scalars(query)))


def open_rows(db: Session, session_id: str) -> list[AlarmRow]:
    """Return the rows of a session's open alarms, oldest first."""
    newest: dict[tuple[str, str | None], AlarmRow] = {}
    for row in db.scalars(_NEWEST_FIRST, {"session_id": session_id}):
        newest.setdefault((row.code, row.stream), row)
    return sorted((row for row in newest.values() if row.state == "raised"), key=lambda row: row.at)


def open_alarms(db: Session, session_id: str) -> list[AlarmView]:
    """Return the open alarms of a session, for a page that loads or refreshes."""
    return [_view(row, None) for row in open_rows(db, session_id)]


def alarm_history(db: Session, session: StudySession) -> list[AlarmView]:
    """Return all alarms of a session, newest first."""
    cleared: dict[tuple[str, str | None], AlarmRow] = {}
    views = []
    for row in db.scalars(_rows(session.id)):
        key = (row.code, row.stream)
        if row.state == "cleared":
            cleared[key] = row
        else:
            views.append(_view(row, cleared.pop(key, None)))
    return views


def _rows(session_id: str) -> Select[AlarmRow]:
    return select(AlarmRow).where(AlarmRow.session_id == session_id).order_by(AlarmRow.at.desc())


def _view(raised: AlarmRow, cleared: AlarmRow | None) -> AlarmView:
    outcome = None if cleared is None or cleared.message == raised.message else cleared.message
    return AlarmView(
        id=raised.id,
        code=raised.code,
        severity=raised.severity,
        stream=raised.stream,
        message=raised.message,
        value=raised.value,
        unit=raised.unit,
        client_t_s=raised.client_t_s,
        since=raised.at,
        cleared_at=None if cleared is None else cleared.at,
        outcome=outcome,
    )


def _add(db: Session, session_id: str, condition: Condition, state: str, at: datetime) -> None:
    value = condition.value
    db.add(
        AlarmRow(
            session_id=session_id,
            code=condition.code,
            severity=condition.severity,
            state=state,
            stream=condition.stream,
            message=condition.message[:MESSAGE_LENGTH],
            value=value if value is not None and math.isfinite(value) else None,
            unit=condition.unit,
            client_t_s=condition.client_t_s,
            at=at,
        )
    )
    db.flush()
