"""The pre-flight list: made for every request, never stored.

What is stored is that somebody went on although a check had failed: an event of the session, with
the reason and the finding as content of their own, so that an erasure takes the words along.
"""

from collections.abc import Mapping

from anyio.to_thread import run_sync
from sqlalchemy.orm import Session

from app.errors import Conflict
from app.features.people.audit import record
from app.features.record.preflight.check import (
    Found,
    PreflightCheck,
    Situation,
    StateCheck,
    TrialCheck,
)
from app.features.record.preflight.checks import CHECKS
from app.features.record.preflight.schemas import Check, Override, OverrideRequest, Preflight
from app.features.record.sessions import (
    OverrideCheck,
    apply_command,
    content_body,
    contents_of,
    store_content,
)
from app.models import StudySession
from app.platform.access import OVER, session_by_id
from app.platform.context import AppContext

CONTENT = "preflight"
"""Kind of the contents that hold reasons."""


async def preflight_of(context: AppContext, session_id: str) -> Preflight:
    """The whole list. Raises NotFound, and Conflict for a session that is over.

    It takes transactions of its own: the written row must be committed before it is read back.
    """
    await run_sync(_open_session, context, session_id)
    tried = {
        check.key: await check.attempt(context, session_id)
        for check in CHECKS
        if isinstance(check, TrialCheck)
    }
    return await run_sync(_list, context, session_id, tried)


def _open_session(context: AppContext, session_id: str) -> None:
    with context.database.reading() as db:
        require_open(session_by_id(db, session_id))


def _list(context: AppContext, session_id: str, found: dict[str, Found]) -> Preflight:
    """The list, from what the trials have found and what the other checks read now."""
    with context.database.reading() as db:
        session = session_by_id(db, session_id)
        overrides = overrides_of(db, session_id)
        situation = Situation(session, db, context, context.hub.signal(session_id) or {})
        looked = {
            check.key: check.look(situation) for check in CHECKS if isinstance(check, StateCheck)
        }
    checks = [_line(check, (found | looked)[check.key]) for check in CHECKS]
    shown = [_with(check, overrides) for check in checks]
    return Preflight(
        at=context.clock.utc_now(),
        clear=all(check.status != "fail" for check in shown),
        asks=session.kind == "people",
        checks=shown,
    )


def _line(check: PreflightCheck, found: Found) -> Check:
    return Check(
        key=check.key,
        status=check.finding(found.finding).status,
        code=check.code(found.finding),
        value=found.value,
        unit=found.unit,
        expected=found.expected,
        limit=found.limit,
        details=found.details,
    )


def require_open(session: StudySession) -> None:
    """Raise Conflict where the session is over."""
    if session.status in OVER:
        raise Conflict(
            "the session is over, so there is nothing left to check",
            value=session.status,
            valid=["planned", "active"],
            remedy="Its overrides stand in the event log.",
        )


def override(
    db: Session, context: AppContext, session_id: str, wish: OverrideRequest, found: Check, by: str
) -> Check:
    """Put on record that somebody goes on although a check is not green; the check after it.

    `found` is the check as it is now. One that has turned green needs nobody's word: it is returned
    as it is, and nothing is recorded. Raises Conflict where the session is over.
    """
    session = session_by_id(db, session_id, lock=True)
    require_open(session)
    if found.status == "ok":
        return found
    now = context.clock.utc_now()
    said = Override(reason=wish.reason, by=by, at=now, found=found.code)
    body = {"check": wish.check, **said.model_dump(mode="json", include={"reason", "found"})}
    body["value"], body["unit"], body["details"] = found.value, found.unit, list(found.details)
    content = store_content(db, session_id=session.id, kind=CONTENT, body=body, by=by, now=now)
    apply_command(db, context, session, OverrideCheck(check=wish.check, content=content), actor=by)
    details = {"check": wish.check}
    record(
        db,
        actor=by,
        action="session.overridden",
        subject=session.id,
        details=details,
        now=now,
    )
    return found.model_copy(update={"status": "overridden", "override": said})


def overrides_of(db: Session, session_id: str) -> dict[str, Override]:
    """The newest override of each check that has one; none once they were erased."""
    newest: dict[str, Override] = {}
    for row in contents_of(db, session_id, CONTENT):
        body = content_body(row)
        if isinstance(body, dict):
            newest[body["check"]] = Override(
                reason=body["reason"], found=body["found"], by=row.created_by, at=row.created_at
            )
    return newest


def _with(check: Check, overrides: Mapping[str, Override]) -> Check:
    """The check with what was said about it.

    One that has become green stays green. Words about one finding do not cover another.
    """
    said = overrides.get(check.key)
    if said is None:
        return check
    covered = check.status != "ok" and check.code == said.found
    return check.model_copy(
        update={"status": "overridden" if covered else check.status, "override": said}
    )
