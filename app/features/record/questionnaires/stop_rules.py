"""Stop rules: check the latest scores of a session against the study's safety limits.

Every rule is evaluated on the latest scores whenever a form is submitted, so a warning stays until
a later form of the same instrument is below the limit. A score that is missing, because an item was
left out, raises its own warning: it must not be mistaken for a good score.
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
    """The level of each stop rule on the latest scores, and the rules that the new form meets."""

    levels: tuple[Level, ...]
    met: tuple[int, ...]


@dataclass(frozen=True)
class Scored:
    """A stored form, reduced to the data that stop rules need."""

    instrument: str
    administration: str
    scores: Mapping[str, float | None]


def judge(db: Session, session: StudySession, instrument: str) -> Judgement:
    """Evaluate all stop rules after a form of `instrument` and its scores were stored."""
    rules = _rules(db, session)
    stored = _newest_first(db, session, rules)
    levels = tuple(_level(stored, rule) for rule in rules)
    met = tuple(
        at
        for at, (rule, level) in enumerate(zip(rules, levels, strict=True))
        if level == "met" and rule.instrument == instrument
    )
    return Judgement(levels, met)


def update_alarms(db: Session, session: StudySession, judgement: Judgement, now: datetime) -> None:
    """Raise the alarms that follow from the levels, and clear warnings that no longer apply."""
    rules = _rules(db, session)
    if not rules:
        return
    raised = {row.code for row in open_rows(db, session.id)}
    for code, level in ((NEAR, "near"), (UNKNOWN, "unknown")):
        at = [at for at, one in enumerate(judgement.levels) if one == level]
        if bool(at) != (code in raised):
            message = _message(code, rules[at[0]]) if at else "a later form is below the limit"
            state: Literal["raised", "cleared"] = "raised" if at else "cleared"
            store_change(db, session.id, Change(state, Condition(code, message), now))
    if judgement.met:
        message = _message(MET, rules[judgement.met[0]])
        store_change(db, session.id, Change("raised", Condition(MET, message), now))


def _rules(db: Session, session: StudySession) -> Sequence[StopRule]:
    safety = protocol_of_session(db, session).safety
    return () if safety is None else safety.stop_rules


def _message(code: str, rule: StopRule) -> str:
    """Describe a stop rule by the keys of the study file, without the score itself.

    The score itself is stored only with the answers.
    """
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
    """Return the latest form of an instrument whose administration key has this prefix."""
    matching = (
        form
        for form in stored
        if form.instrument == instrument and form.administration.startswith(administration)
    )
    return next(matching, None)


def _newest_first(
    db: Session, session: StudySession, rules: Sequence[StopRule]
) -> Sequence[Scored]:
    """Return the session's stored forms that any rule refers to, newest first."""
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
