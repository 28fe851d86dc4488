"""Endpoints with which the participant reads and answers inside the headset.

They are those of the tablet, for the session of the headset's token: the same checks, the same
events, and the same idempotence.
"""

from fastapi import APIRouter, Request
from pydantic import BaseModel, ConfigDict, Field
from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotNow
from app.features.record.doubts import judge_with_doubts
from app.features.record.questionnaires import (
    Administration,
    Receipt,
    SubmissionRequest,
    current_administration,
    due_form,
    submit,
)
from app.features.record.sessions import (
    CompleteStep,
    apply_command,
    choose_language,
    plan_of,
    state_of,
)
from app.platform.access import session_by_id
from app.platform.dependencies import (
    Context,
    PairedHeadset,
    Reading,
    Writing,
    headset_in,
    write,
)

router = APIRouter(prefix="/vr", tags=["headset"])


class StepRead(BaseModel):
    """A request to complete a step whose text was read inside the headset."""

    model_config = ConfigDict(extra="forbid")

    step_index: int = Field(ge=0, lt=1000)


class HeadsetLanguage(BaseModel):
    """The language of the session, which the participant may choose inside the headset."""

    model_config = ConfigDict(extra="forbid")

    language: str = Field(max_length=8)


@router.get("/form")
def get_form(db: Reading, headset: PairedHeadset) -> Administration:
    """Return the form to answer inside the headset; raise NotNow if none is due there."""
    session = session_by_id(db, headset.session_id)
    due = due_form(db, session)
    form = current_administration(db, session)
    if due is None or form is None or due.step.forms != "headset":
        raise NotNow(
            "no form is due inside the headset",
            value=None if due is None else due.step.forms,
            valid="headset",
            remedy="Follow the panel of the newest state message.",
        )
    return form


@router.post("/submissions")
async def post_form(
    request: Request, form: SubmissionRequest, context: Context, _: PairedHeadset
) -> Receipt:
    """Store a filled-in form; it can be resent any number of times under the same key."""

    def store(db: Session) -> Receipt:
        # Check again: the headset may have been unpaired while the form waited.
        headset = headset_in(db, request)
        session = session_by_id(db, headset.session_id, lock=True)
        return submit(db, context, session, form, mode="headset", actor=f"headset:{headset.id}")

    return await write(context, store)


@router.post("/acknowledge", status_code=204)
def post_read(request: StepRead, db: Writing, context: Context, headset: PairedHeadset) -> None:
    """Complete a step of instructions that were read inside the headset, once."""
    session = session_by_id(db, headset.session_id, lock=True)
    plan = plan_of(db, session)
    readable = [step.index for step in plan if step.kind == "instructions"]
    if request.step_index not in readable:
        raise InvalidInput(
            "this step cannot be completed inside the headset",
            value=request.step_index,
            valid=readable,
            remedy="Follow the panel of the newest state message.",
        )
    if state_of(session).steps[request.step_index].status in ("done", "skipped"):
        return
    command = CompleteStep(by="headset", step=request.step_index)
    apply_command(db, context, session, command, actor=f"headset:{headset.id}")
    judge_with_doubts(db, session)


@router.put("/language")
def put_language(
    choice: HeadsetLanguage, db: Writing, context: Context, headset: PairedHeadset
) -> HeadsetLanguage:
    """Switch the session to another language of the study."""
    session = session_by_id(db, headset.session_id, lock=True)
    choose_language(db, context, session, choice.language)
    return choice
