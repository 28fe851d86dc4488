"""Which screen a tablet shows: its own session's current step and nothing about the condition."""

from collections.abc import Mapping, Sequence

from sqlalchemy.orm import Session

from app.features.record.questionnaires import current_administration
from app.features.record.sessions import (
    SessionState,
    consent_form,
    plan_of,
    protocol_of_session,
    state_of,
)
from app.features.record.tablet.help import help_asked
from app.features.record.tablet.schemas import Screen, TabletState
from app.models import StudySession
from app.protocol import StudyProtocol
from app.protocol.plan import Step

_SCREENS: dict[str, Screen] = {
    "consent": "consent",
    "instructions": "instructions",
    "form": "form",
    "questionnaire": "form",
}


def tablet_state(db: Session, session: StudySession) -> TabletState:
    """The screen of this session's tablet."""
    protocol = protocol_of_session(db, session)
    plan, state = plan_of(db, session), state_of(session)
    step = None if state.current is None else plan[state.current]
    ended = state.status in ("completed", "aborted", "withdrawn")
    screen = _screen(step, ended=ended, held=state.held is not None)
    language = session.language
    return TabletState(
        session_id=session.id,
        version=session.version,
        language=language,
        languages=list(protocol.languages),
        simulated=session.kind == "simulated",
        screen=screen,
        step_index=state.current,
        title=None if step is None else _text(step.title, language),
        text=_words(protocol, plan, step, language, screen),
        next=None if screen == "held" else _next(plan, state, language),
        administration=current_administration(db, session) if screen == "form" else None,
        consent=consent_form(step, language) if step and screen == "consent" else None,
        help_asked=help_asked(db, session.id),
    )


def _screen(step: Step | None, *, ended: bool, held: bool) -> Screen:
    if ended:
        return "finished"
    if held:
        return "held"
    return "waiting" if step is None else _SCREENS.get(step.kind, "waiting")


def _words(
    protocol: StudyProtocol,
    plan: Sequence[Step],
    step: Step | None,
    language: str,
    screen: Screen,
) -> str | None:
    """The text of the step, or the study's calm waiting text; the tablet's own when held."""
    if screen == "held":
        return None
    if screen == "finished":
        # Debriefing is the last thing a participant reads.
        step = next((late for late in reversed(plan) if late.kind == "debrief"), None)
    if step is not None and step.text is not None:
        return _text(protocol.texts[step.text], language)
    if screen == "waiting" and "waiting" in protocol.texts:
        return _text(protocol.texts["waiting"], language)
    return None


def _next(plan: Sequence[Step], state: SessionState, language: str) -> str | None:
    if state.status == "planned":
        return _text(plan[0].title, language)
    if state.current is None or state.current + 1 >= len(plan):
        return None
    return _text(plan[state.current + 1].title, language)


def _text(text: Mapping[str, str], language: str) -> str:
    return text.get(language) or next(iter(text.values()), "")
