"""Which form a session asks for now."""

from dataclasses import dataclass

import numpy as np
from sqlalchemy.orm import Session

from app.features.design.studies import UsedInstrument, used_instrument
from app.features.record.questionnaires.schemas import Administration
from app.features.record.sessions import plan_of, state_of
from app.models import StudySession
from app.protocol import Step
from app.science.instruments import item_order

FORM_KINDS = ("form", "questionnaire")


@dataclass(frozen=True)
class DueForm:
    """A step that asks for a form, and the wording it asks for; `attempt` counts from 1."""

    step: Step
    attempt: int
    used: UsedInstrument

    @property
    def key(self) -> str:
        """The name of one filling-in of a step: doing the step over makes another."""
        return f"{self.step.key}#{self.attempt}"


def due_form(db: Session, session: StudySession) -> DueForm | None:
    """The form that is due now, or None."""
    state = state_of(session)
    if state.current is None:
        return None
    step = plan_of(db, session)[state.current]
    if step.kind not in FORM_KINDS or step.instrument is None:
        return None
    used = used_instrument(db, session.study_version_id, step.instrument)
    return DueForm(step, state.steps[step.index].attempt, used)


def current_administration(db: Session, session: StudySession) -> Administration | None:
    """The form that is due now as a page gets it, or None."""
    due = due_form(db, session)
    if due is None:
        return None
    instrument, seed = due.used.instrument, _item_seed(session, due)
    return Administration(
        key=due.key,
        step_index=due.step.index,
        instrument=dict(due.used.definition),
        item_order=list(item_order(instrument, seed)),
        seed=seed,
        language=session.language,
        languages=list(instrument.languages),
    )


def _item_seed(session: StudySession, due: DueForm) -> int:
    sequence = np.random.SeedSequence([session.seed, due.step.index, due.attempt])
    return int(sequence.generate_state(1)[0])
