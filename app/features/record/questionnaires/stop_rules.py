"""Stop rules: what the newest scores of a session mean for its safety.

Every rule is looked at again whenever a form comes, on the newest scores there are, so a warning
stays until a later form of the same instrument is below it. A score that is missing, because an
item was left out, is a warning of its own: it must not pass for a good one.
"""

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import datetime
from typing import Literal

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.features.record.alarms import Change, Condition, open_rows, store_change
from app.features.record.sessions import protocol_of_session
from app.models import ScoreValue, StudySession, Submission
from app.protocol import StopRule

Level = Literal["unasked", "fine", "near", "met", "unknown"]
MET, NEAR, UNKNOWN = "stop_rule_met", "stop_rule_near", "stop_rule_unknown"


@dataclass(frozen=True)
class Judgement:
    """Each rule's level on the newest scores, and which rules the form that came now meets."""

    levels: tuple[Level, ...]
    met: tuple[int, ...]


@dataclass(frozen=True)
class Scored:
    """A stored form, by what a rule may want of it."""

    instrument: str
    administration: str
    scores: Mapping[str, float | None]


def judge(db: Session, session: StudySession, instrument: str) -> Judgement:
    """Look at all stop rules after a form of `instrument` and its scores were stored."""
    rules = _rules(db, session)
    stored = _newest_first(db, session, rules)
    levels = tuple(_level(stored, rule) for rule in rules)
    met = tuple(
        at
        for at, (rule, level) in enumerate(zip(rules, levels, strict=True))
        if level == "met" and rule.instrument == instrument
    )
    return Judgement(levels, met)


def tell(db: Session, session: StudySession, judgement: Judgement, now: datetime) -> None:
    """Raise the alarms that follow from the levels, and clear the warnings that are over."""
    rules = _rules(db, session)
    if not rules:
        return
    told = {row.code for row in open_rows(db, session.id)}
    for code, level in ((NEAR, "near"), (UNKNOWN, "unknown")):
        at = [at for at, one in enumerate(judgement.levels) if one == level]
        if bool(at) != (code in told):
            message = _message(code, rules[at[0]]) if at else "a later form is fine"
            state: Literal["raised", "cleared"] = "raised" if at else "cleared"
            store_change(db, session.id, Change(state, Condition(code, message), now))
    if judgement.met:
        message = _message(MET, rules[judgement.met[0]])
        store_change(db, session.id, Change("raised", Condition(MET, message), now))


def _rules(db: Session, session: StudySession) -> Sequence[StopRule]:
    safety = protocol_of_session(db, session).safety
    return () if safety is None else safety.stop_rules


def _message(code: str, rule: StopRule) -> str:
    """In the words of the study file; the value itself stays with the answers."""
    what = f"{rule.score} of {rule.instrument}"
    if code == UNKNOWN:
        return f"the stop rule on {what} could not be applied: the score is missing"
    limit = rule.stop_at if code == MET else rule.warn_at
    rise = f", risen since {rule.change_from}," if rule.change_from else ""
    return f"{what}{rise} is at or above {limit:g}"


def _level(stored: Sequence[Scored], rule: StopRule) -> Level:
    newest = _newest(stored, rule.instrument)
    if newest is None:
        return "unasked"
    value = newest.scores.get(rule.score)
    if rule.change_from is not None:
        # `form.fms#2`: the second attempt at the step form.fms.
        start = _newest(stored, rule.instrument, administration=f"{rule.change_from}#")
        before = None if start is None else start.scores.get(rule.score)
        value = None if value is None or before is None else value - before
    if value is None:
        return "unknown"
    if value >= rule.stop_at:
        return "met"
    return "near" if rule.warn_at is not None and value >= rule.warn_at else "fine"


def _newest(stored: Sequence[Scored], instrument: str, administration: str = "") -> Scored | None:
    """The newest form of an instrument whose administration begins so."""
    wanted = (
        form
        for form in stored
        if form.instrument == instrument and form.administration.startswith(administration)
    )
    return next(wanted, None)


def _newest_first(
    db: Session, session: StudySession, rules: Sequence[StopRule]
) -> Sequence[Scored]:
    """The session's stored forms that any rule asks about."""
    if not rules:
        return ()
    rows = db.execute(
        select(Submission.id, Submission.instrument, Submission.administration)
        .add_columns(ScoreValue.score, ScoreValue.value)
        .outerjoin(ScoreValue, ScoreValue.submission_id == Submission.id)
        .where(
            Submission.session_id == session.id,
            Submission.instrument.in_(sorted({rule.instrument for rule in rules})),
        )
        .order_by(Submission.submitted_at.desc(), Submission.step_index.desc())
    )
    forms: dict[str, Scored] = {}
    scores: dict[str, dict[str, float | None]] = defaultdict(dict)
    for id_, instrument, administration, score, value in rows:
        forms.setdefault(id_, Scored(instrument, administration, scores[id_]))
        if score is not None:
            scores[id_][score] = value
    return tuple(forms.values())
