"""Run the pre-flight checks; their results are computed for every request and never stored.

What is stored is an override, by which somebody proceeds although a check has failed: an event of
the session, with reason and finding as separate content, so that an erasure removes these texts.
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
from app.features.record.preflight.checks.registry import CHECKS
from app.features.record.preflight.schemas import Check, Override, OverrideRequest, Preflight
from app.features.record.sessions import (
    OverrideCheck,
    apply_command,
    content_body,
    contents_of,
    store_content,
)
from app.models import StudySession
from app.platform.access import ENDED_STATUSES, session_by_id
from app.platform.context import AppContext

CONTENT = "preflight"
"""The kind of stored content that contains the reasons of overrides."""
GREEN = frozenset({"ok", "unneeded"})
"""The statuses of checks that need no override."""


async def preflight_of(context: AppContext, session_id: str) -> Preflight:
    """Run all checks of a session; raises NotFound, and Conflict if the session has ended.

    This opens its own transactions, since the test row must be committed before it is read back.
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
    """Combine the results of the trials with those of the read-only checks and the overrides."""
    with context.database.reading() as db:
        session = session_by_id(db, session_id)
        overrides = overrides_of(db, session_id)
        situation = Situation(session, db, context, context.hub.signal(session_id) or {})
        read = {
            check.key: check.run(situation) for check in CHECKS if isinstance(check, StateCheck)
        }
    checks = [_line(check, (found | read)[check.key]) for check in CHECKS]
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
    """Raise Conflict if the session has ended."""
    if session.status in ENDED_STATUSES:
        raise Conflict(
            "the session has ended, so there is nothing left to check",
            value=session.status,
            valid=["planned", "active"],
            remedy="Its overrides are in the event log.",
        )


def override(
    db: Session,
    context: AppContext,
    session_id: str,
    request: OverrideRequest,
    found: Check,
    by: str,
) -> Check:
    """Record that somebody proceeds although a check is not green; return the overridden check.

    `found` is the check's current result. If it has turned green in the meantime, it is returned
    unchanged and nothing is recorded. Raises Conflict if the session has ended.
    """
    session = session_by_id(db, session_id, lock=True)
    require_open(session)
    if found.status in GREEN:
        return found
    now = context.clock.utc_now()
    latest = Override(reason=request.reason, by=by, at=now, found=found.code)
    body = {"check": request.check, **latest.model_dump(mode="json", include={"reason", "found"})}
    body["value"], body["unit"], body["details"] = found.value, found.unit, list(found.details)
    content = store_content(db, session_id=session.id, kind=CONTENT, body=body, by=by, now=now)
    apply_command(
        db, context, session, OverrideCheck(check=request.check, content=content), actor=by
    )
    details = {"check": request.check}
    record(
        db,
        actor=by,
        action="session.overridden",
        subject=session.id,
        details=details,
        now=now,
    )
    return found.model_copy(update={"status": "overridden", "override": latest})


def overrides_of(db: Session, session_id: str) -> dict[str, Override]:
    """Return the latest override of each check that has one; none once they were erased."""
    newest: dict[str, Override] = {}
    for row in contents_of(db, session_id, CONTENT):
        body = content_body(row)
        if isinstance(body, dict):
            newest[body["check"]] = Override(
                reason=body["reason"], found=body["found"], by=row.created_by, at=row.created_at
            )
    return newest


def _with(check: Check, overrides: Mapping[str, Override]) -> Check:
    """Return the check with its latest override.

    A check that is green stays green, and the override of one finding does not apply to another.
    """
    latest = overrides.get(check.key)
    if latest is None:
        return check
    covered = check.status not in GREEN and check.code == latest.found
    return check.model_copy(
        update={"status": "overridden" if covered else check.status, "override": latest}
    )
