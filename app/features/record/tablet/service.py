"""Determine which screen a tablet shows, and record the participant's calls for the experimenter.

The screen shows only its own session's current step and reveals nothing about the condition. A call
is an alarm of the session: it is recorded with its times, every page shows it, and it stays open
until somebody answers it, the participant cancels it or the session ends. A question about a text
and a refused consent are alarms too, which the session's engine raises: they are events of its log.
"""

from collections.abc import Mapping, Sequence
from typing import Literal

from sqlalchemy.orm import Session

from app.features.record.alarms import Change, Condition, open_rows, store_change
from app.features.record.questionnaires import current_administration
from app.features.record.sessions import (
    SessionState,
    consent_form,
    plan_of,
    protocol_of_session,
    state_of,
)
from app.features.record.tablet.schemas import Screen, TabletState
from app.models import StudySession
from app.platform.context import AppContext
from app.protocol import FormPlace, Step, StudyProtocol
from app.texts import chosen

CODE = "help_asked"
QUESTION = "question_asked"
_FORM_SCREENS: Mapping[FormPlace, Screen] = {
    "tablet": "form",
    "headset": "in_headset",
    "oral": "oral",
}
_OVER = ("completed", "aborted", "withdrawn")
_CALL_WORDS = {
    "asked": "The participant called the experimenter from the tablet.",
    "taken_back": "The participant no longer needs help.",
    "answered": "The experimenter went to the participant.",
}


def tablet_state(db: Session, session: StudySession) -> TabletState:
    """Return the current screen of this session's tablet."""
    protocol = protocol_of_session(db, session)
    plan, state = plan_of(db, session), state_of(session)
    step = None if state.current is None else plan[state.current]
    ended = state.status in ("completed", "aborted", "withdrawn")
    screen = _screen(step, state, ended=ended)
    language = session.language
    called = {row.code for row in open_rows(db, session.id)}
    own = _own_text(step, screen)
    return TabletState(
        session_id=session.id,
        version=session.version,
        language=language,
        languages=list(protocol.languages),
        simulated=session.kind == "simulated",
        screen=screen,
        step_index=state.current,
        title=None if step is None else chosen(step.title, language),
        text=_words(protocol, plan, own, state, language, screen),
        is_own_text=own is not None,
        next=None if screen in ("held", "refused") else _next(plan, state, language),
        administration=current_administration(db, session) if screen == "form" else None,
        consent=consent_form(step, language) if step and screen == "consent" else None,
        help_asked=CODE in called,
        question_asked=QUESTION in called,
        is_refused=state.refused_consent is not None,
    )


def _screen(step: Step | None, state: SessionState, *, ended: bool) -> Screen:
    if ended:
        return "finished"
    if state.refused_consent is not None:
        return "refused"
    if state.held is not None:
        return "held"
    if step is None:
        return "waiting"
    return _FORM_SCREENS[step.forms] if step.spec.screen == "form" else step.spec.screen


def _own_text(step: Step | None, screen: Screen) -> Step | None:
    """Return the step whose text is shown; None if it has no text or none should be read now."""
    nothing = step is None or step.text is None or screen in ("held", "refused", "finished")
    return None if nothing else step


def _words(
    protocol: StudyProtocol,
    plan: Sequence[Step],
    own: Step | None,
    state: SessionState,
    language: str,
    screen: Screen,
) -> str | None:
    """Return the text of the step or the study's waiting text; None if the tablet has its own."""
    if screen == "finished" and state.refused_consent is None:
        # The debriefing is shown at the end, but not to participants who refused to take part.
        own = next((late for late in reversed(plan) if late.kind == "debrief"), None)
    if own is not None and own.text is not None:
        return chosen(protocol.texts[own.text], language)
    if screen == "waiting" and "waiting" in protocol.texts:
        return chosen(protocol.texts["waiting"], language)
    return None


def _next(plan: Sequence[Step], state: SessionState, language: str) -> str | None:
    if state.status == "planned":
        return chosen(plan[0].title, language)
    if state.current is None or state.current + 1 >= len(plan):
        return None
    return chosen(plan[state.current + 1].title, language)


def may_ask(state: SessionState) -> bool:
    """Return whether the participant can still call the experimenter: until the session ends."""
    return state.status not in _OVER


def note_help(
    db: Session,
    context: AppContext,
    session: StudySession,
    what: Literal["asked", "taken_back", "answered"],
) -> None:
    """Record a call, its cancellation or its answer; one that changes nothing is not recorded."""
    change: Literal["raised", "cleared"] = "raised" if what == "asked" else "cleared"
    if store_change(
        db,
        session.id,
        Change(change, Condition(CODE, _CALL_WORDS[what]), context.clock.utc_now()),
    ):
        context.hub.publish_after_commit(db, session.id)
