"""Stop rules: what the newest scores of a session mean for its safety.

Every rule is looked at again whenever a form comes, on the newest scores there are, so a warning
stays until a later form of the same instrument is below it. A score that is missing, because an
item was left out, is a warning of its own: it must not pass for a good one.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Literal

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.alarms.alarm import Change, Condition
from app.features.alarms.service import store_change
from app.features.sessions.service import protocol_of_session
from app.models import ScoreValue, StudySession, Submission
from app.protocol import StopRule

Level = Literal["unasked", "fine", "near", "met", "unknown"]
MET, NEAR, UNKNOWN = "stop_rule_met", "stop_rule_near", "stop_rule_unknown"


@dataclass(frozen=True)
class Judgement:
    """Each rule's level on the newest scores, and which rules the form that came now meets."""

    levels: tuple[Level, ...]
    met: tuple[int, ...]


def judge(db: Session, session: StudySession, submission: Submission) -> Judgement:
    """Look at all stop rules after `submission` and its scores were stored."""
    safety = protocol_of_session(db, session).safety
    rules: Sequence[StopRule] = () if safety is None else safety.stop_rules
    levels = tuple(_level(db, session, rule) for rule in rules)
    met = tuple(
        at
        for at, (rule, level) in enumerate(zip(rules, levels, strict=True))
        if level == "met" and rule.instrument == submission.instrument
    )
    return Judgement(levels, met)


def tell(db: Session, session: StudySession, judgement: Judgement, now: datetime) -> None:
    """Raise the alarms that follow from the levels, and clear the warnings that are over."""
    safety = protocol_of_session(db, session).safety
    if safety is None:
        return
    for code, level in ((NEAR, "near"), (UNKNOWN, "unknown")):
        rules = [at for at, one in enumerate(judgement.levels) if one == level]
        message = _message(code, safety.stop_rules[rules[0]]) if rules else "a later form is fine"
        state: Literal["raised", "cleared"] = "raised" if rules else "cleared"
        store_change(db, session.id, Change(state, Condition(code, message), now))
    if judgement.met:
        message = _message(MET, safety.stop_rules[judgement.met[0]])
        store_change(db, session.id, Change("raised", Condition(MET, message), now))


def _message(code: str, rule: StopRule) -> str:
    """In the words of the study file; the value itself stays with the answers."""
    what = f"{rule.score} of {rule.instrument}"
    if code == UNKNOWN:
        return f"the stop rule on {what} could not be applied: the score is missing"
    limit = rule.stop_at if code == MET else rule.warn_at
    rise = f", risen since {rule.change_from}," if rule.change_from else ""
    return f"{what}{rise} is at or above {limit:g}"


def _level(db: Session, session: StudySession, rule: StopRule) -> Level:
    newest = _newest(db, session, rule.instrument)
    if newest is None:
        return "unasked"
    value = _score(db, newest, rule.score)
    if rule.change_from is not None:
        start = _newest(db, session, rule.instrument, step_key=rule.change_from)
        before = None if start is None else _score(db, start, rule.score)
        value = None if value is None or before is None else value - before
    if value is None:
        return "unknown"
    if value >= rule.stop_at:
        return "met"
    return "near" if rule.warn_at is not None and value >= rule.warn_at else "fine"


def _newest(
    db: Session, session: StudySession, instrument: str, step_key: str | None = None
) -> Submission | None:
    query = select(Submission).where(
        Submission.session_id == session.id, Submission.instrument == instrument
    )
    if step_key is not None:
        # `form.fms#2`: the second attempt at the step form.fms.
        query = query.where(Submission.administration.startswith(f"{step_key}#", autoescape=True))
    return db.scalar(query.order_by(Submission.submitted_at.desc(), Submission.step_index.desc()))


def _score(db: Session, submission: Submission, key: str) -> float | None:
    value = db.get(ScoreValue, (submission.id, key))
    return None if value is None else value.value
