"""What the participant reads, answers or does inside the headset, beside the scene.

It is the counterpart of the tablet's screen: where one of the two is used, the other one says so.
Like the tablet's, it belongs to the current step and reveals nothing about the condition.
"""

from sqlalchemy.orm import Session

from app.features.record.alarms import open_rows
from app.features.record.questionnaires import due_form
from app.features.record.sessions import SessionState, protocol_of_session
from app.models import StudySession
from app.protocol import FORM_KINDS, TIMED_KINDS, Step, StudyProtocol
from app.texts import chosen
from app.wire import PanelOrder

_CALLS = frozenset({"help_asked", "question_asked", "stop_asked"})
"""Alarms that say that the participant has called and nobody has come yet."""
_DURING_PHASES = ("freeze", "walk_back")
"""Texts of a study that are shown while a phase is under way."""

_ON_THE_TABLET = ("consent", "debrief")


def panel_order(
    db: Session, session: StudySession, state: SessionState, step: Step | None
) -> PanelOrder:
    """Return what the headset shows now; `step` is the current one, None if there is none."""
    protocol, language = protocol_of_session(db, session), session.language
    is_held = state.held is not None or state.refused_consent is not None
    answer = step.forms if step is not None and step.kind in FORM_KINDS else None
    due = due_form(db, session) if answer == "headset" and not is_held else None
    reads = step is not None and step.kind == "instructions" and not is_held
    return PanelOrder(
        language=language,
        title=None if step is None else chosen(step.title, language),
        text=None if is_held else _text(protocol, step, language),
        form=None if due is None else due.key,
        answer=answer,
        acknowledge=reads,
        headset_off=_is_off(state, step),
        held=is_held,
        called=any(row.code in _CALLS for row in open_rows(db, session.id)),
        limb=step.limb if step is not None and step.kind in TIMED_KINDS else None,
        screen_texts={
            key: chosen(protocol.texts[key], language)
            for key in _DURING_PHASES
            if key in protocol.texts
        },
    )


def _text(protocol: StudyProtocol, step: Step | None, language: str) -> str | None:
    """Return the text of the step, or the study's waiting text; None if there is none to read."""
    key = "waiting" if step is None or step.text is None else step.text
    return chosen(protocol.texts[key], language) if key in protocol.texts else None


def _is_off(state: SessionState, step: Step | None) -> bool:
    """Return whether the participant should take the headset off now.

    Instructions can be read in both; before there is a body, the participant is at the tablet.
    """
    if step is None:
        return state.status not in ("planned", "active") and state.materialised
    if step.kind in FORM_KINDS:
        return step.forms == "tablet"
    return step.kind in _ON_THE_TABLET or (step.kind == "instructions" and not state.materialised)
