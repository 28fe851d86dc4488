"""What holds a session, in the words of the study's instrument."""

from collections.abc import Mapping

from sqlalchemy.orm import Session

from app.features.design.studies.service import instrument_for, instrument_of
from app.features.record.sessions.engine import SessionState
from app.features.record.sessions.schemas import HeldView
from app.models import StudyVersion
from app.protocol import StudyProtocol


def held_view(
    db: Session, version: StudyVersion, protocol: StudyProtocol, state: SessionState
) -> HeldView | None:
    """The stop rule that was met; None where the session is not held."""
    if state.held is None or protocol.safety is None:
        return None
    rule = protocol.safety.stop_rules[state.held.rule]
    instrument = instrument_of(instrument_for(db, version, rule.instrument))
    labels = {score.key: score.label for score in instrument.scores}
    return HeldView(
        rule=state.held.rule,
        instrument=_text(instrument.title),
        score=_text(labels[rule.score]),
        stop_at=rule.stop_at,
        is_rise=rule.change_from is not None,
    )


def _text(text: Mapping[str, str]) -> str:
    return text.get("en") or next(iter(text.values()), "")
