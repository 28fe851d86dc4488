"""HTTP endpoints for tablets, whose cookie gives access to their own session only."""

import asyncio
from collections.abc import AsyncIterator

from anyio.to_thread import run_sync
from fastapi import APIRouter, Request, Response
from fastapi.sse import EventSourceResponse, ServerSentEvent
from pydantic import ValidationError
from sqlalchemy.orm import Session

from app.errors import InvalidInput, NotSignedIn
from app.features.record.doubts import judge_with_doubts
from app.features.record.questionnaires import SubmissionRequest, submit
from app.features.record.sessions import (
    AskQuestion,
    CloseQuestion,
    CloseStop,
    CompleteStep,
    ConsentDesk,
    ConsentGiven,
    RefuseConsent,
    RetractRefusal,
    apply_command,
    choose_language,
    plan_of,
    state_of,
)
from app.features.record.tablet.schemas import (
    Acknowledgement,
    FormStored,
    HelpWish,
    LanguageChoice,
    RefusalWish,
    TabletPaired,
    TabletState,
)
from app.features.record.tablet.service import may_ask, note_help, tablet_state
from app.lan import STRANGER
from app.models import Device, StudySession
from app.platform.access import session_by_id
from app.platform.admission import TABLET_COOKIE, bearer_token
from app.platform.context import AppContext
from app.platform.dependencies import (
    API_PREFIX,
    Context,
    PairedTablet,
    SignedIn,
    Writing,
    tablet_in,
    write,
)
from app.platform.direct_routes import DirectRoute, is_json, json_response
from app.platform.tokens import device_of_token, read_cookie
from app.protocol import STEP_KINDS, Step

calls = APIRouter(tags=["sessions"])
"""Endpoints with which the console answers a participant's call."""
router = APIRouter(prefix="/tablet", tags=["tablet"])
HEARTBEAT_S = 10.0
_READ_KINDS = tuple(
    kind for kind, spec in STEP_KINDS.items() if spec.screen in ("consent", "instructions")
)
"""Steps that the participant reads on the tablet and completes there."""


@router.get("/state", response_model=TabletState)
def get_state(request: Request, context: Context) -> Response:
    """Return the screen that the tablet should show now."""
    with context.database.reading() as db:
        tablet = tablet_in(db, request, context)
        state = tablet_state(db, session_by_id(db, tablet.session_id))
    # Serialised here, because otherwise the event loop would first validate it a second time.
    return Response(state.model_dump_json(), media_type="application/json")


@router.get("/paired", response_model=TabletPaired)
def get_paired(request: Request, context: Context) -> TabletPaired:
    """Return the tablet's screen; null (and not an error) if the tablet is not paired."""
    return _screen_of(context, read_cookie(request, TABLET_COOKIE) or bearer_token(request))


def first_answer(request: Request) -> str | None:
    """Return what `GET /api/tablet/paired` would, for the page itself; None without a cookie."""
    token = read_cookie(request, TABLET_COOKIE)
    if token is None:
        return None
    return _screen_of(request.app.state.context, token).model_dump_json()


def _screen_of(context: AppContext, token: str | None) -> TabletPaired:
    """Return the screen of the tablet that has this token, and note that it was seen."""
    with context.database.reading() as db:
        try:
            tablet = device_of_token(db, token or "", "tablet")
        except NotSignedIn:
            return TabletPaired(state=None)
        context.hub.note_seen(tablet.id, context.clock.utc_now())
        return TabletPaired(state=tablet_state(db, session_by_id(db, tablet.session_id)))


@router.put("/language")
def put_language(
    choice: LanguageChoice, db: Writing, context: Context, tablet: PairedTablet
) -> TabletState:
    """Switch the session to another language of the study."""
    session = session_by_id(db, tablet.session_id, lock=True)
    choose_language(db, context, session, choice.language)
    return tablet_state(db, session)


@router.put("/help")
def put_help(wish: HelpWish, db: Writing, context: Context, tablet: PairedTablet) -> TabletState:
    """Call the experimenter, or cancel the call; repeating the request changes nothing."""
    session = session_by_id(db, tablet.session_id, lock=True)
    if may_ask(state_of(session)):
        note_help(db, context, session, "asked" if wish.asked else "taken_back")
    return tablet_state(db, session)


@router.put("/question")
def put_question(
    wish: HelpWish, db: Writing, context: Context, tablet: PairedTablet
) -> TabletState:
    """Notify the experimenter of a question about the text on the screen, or cancel it."""
    session = session_by_id(db, tablet.session_id, lock=True)
    if may_ask(state_of(session)):
        command = AskQuestion() if wish.asked else CloseQuestion(outcome="taken_back")
        apply_command(db, context, session, command, actor=f"tablet:{tablet.id}")
    return tablet_state(db, session)


@router.put("/refusal")
def put_refusal(
    wish: RefusalWish, db: Writing, context: Context, tablet: PairedTablet
) -> TabletState:
    """Refuse to take part, or take the refusal back; a repeated `wish_id` changes nothing.

    Until the operator has decided, the session cannot continue. Raises NotNow if the session has
    ended.
    """
    session = session_by_id(db, tablet.session_id, lock=True)
    command = (
        RefuseConsent(by="tablet", step=wish.step_index)
        if wish.refused
        else RetractRefusal(by="tablet")
    )
    apply_command(
        db, context, session, command, actor=f"tablet:{tablet.id}", command_id=wish.wish_id
    )
    return tablet_state(db, session)


@router.post("/consent")
def post_consent(
    given: ConsentGiven, db: Writing, context: Context, tablet: PairedTablet
) -> TabletState:
    """Store the participant's consent and complete the step; repeating this changes nothing."""
    session = session_by_id(db, tablet.session_id, lock=True)
    step = _own_step(db, session, given.step_index, ("consent",))
    _complete(db, context, session, step, f"tablet:{tablet.id}", given)
    return tablet_state(db, session)


@router.post("/acknowledge")
def post_acknowledge(
    request: Acknowledgement, db: Writing, context: Context, tablet: PairedTablet
) -> TabletState:
    """Complete a step that was read on the tablet; repeating the request changes nothing."""
    session = session_by_id(db, tablet.session_id, lock=True)
    step = _own_step(db, session, request.step_index, _READ_KINDS)
    given = ConsentGiven(step_index=step.index) if step.kind == "consent" else None
    _complete(db, context, session, step, f"tablet:{tablet.id}", given)
    return tablet_state(db, session)


def _own_step(db: Session, session: StudySession, index: int, kinds: tuple[str, ...]) -> Step:
    """Return the step to complete; raises InvalidInput if the tablet may not complete it."""
    plan = plan_of(db, session)
    step = plan[index] if index < len(plan) else None
    if step is None or step.kind not in kinds:
        raise InvalidInput(
            "this step cannot be completed on the tablet",
            value=index,
            valid=[one.index for one in plan if one.kind in kinds],
            remedy="Wait for the experimenter.",
        )
    return step


def _complete(
    db: Session,
    context: AppContext,
    session: StudySession,
    step: Step,
    actor: str,
    given: ConsentGiven | None,
) -> None:
    """Complete a step once, and store the consent if one was given."""
    if state_of(session).steps[step.index].status in ("done", "skipped"):
        return
    desk = ConsentDesk(db, context, session, actor)
    content = None if given is None else desk.from_tablet(step, given)
    command = CompleteStep(by="tablet", step=step.index, content=content)
    apply_command(db, context, session, command, actor=actor)
    judge_with_doubts(db, session)


@router.post("/submissions")
async def post_submission(
    request: Request, form: SubmissionRequest, context: Context, _: PairedTablet
) -> FormStored:
    """Store a filled-in form; it can be resent any number of times under the same key.

    The answer has the next screen, so that the tablet need not ask for it.
    """
    return await _stored(request, context, form)


async def _answer_submission(request: Request) -> Response | None:
    """Store a form from a known device that is valid; leave all others to `post_submission`."""
    if STRANGER in request.scope or not is_json(request):
        return None
    try:
        form = SubmissionRequest.model_validate_json(await request.body())
    except ValidationError:
        return None
    stored = await _stored(request, request.app.state.context, form)
    return json_response(stored.model_dump_json())


async def _answer_state(request: Request) -> Response:
    """Answer like `get_state`."""
    return await run_sync(get_state, request, request.app.state.context)


direct = (
    DirectRoute("POST", f"{API_PREFIX}{router.prefix}/submissions", _answer_submission),
    DirectRoute("GET", f"{API_PREFIX}{router.prefix}/state", _answer_state),
)
"""The calls that come from all tablets at once when a form ends."""


async def _stored(request: Request, context: AppContext, form: SubmissionRequest) -> FormStored:
    def store(db: Session) -> FormStored:
        # The tablet may have been unpaired while the form waited for the transaction.
        tablet = tablet_in(db, request, context)
        session = session_by_id(db, tablet.session_id, lock=True)
        receipt = submit(db, context, session, form, mode="tablet", actor=f"tablet:{tablet.id}")
        return FormStored(**dict(receipt), state=tablet_state(db, session))

    return await write(context, store)


@router.get("/live", response_class=EventSourceResponse)
async def get_live(context: Context, tablet: PairedTablet) -> AsyncIterator[ServerSentEvent]:
    """Stream the tablet's screen at every change; ends when the tablet is unpaired."""
    with context.hub.subscribe(tablet.session_id) as subscription:
        event = await asyncio.to_thread(_seen, context, tablet.id)
        while event is not None:
            yield event
            news = await subscription.next(HEARTBEAT_S)
            event = await asyncio.to_thread(_seen, context, tablet.id)
            if event is not None and not news:
                event = ServerSentEvent(comment="still here")


def _seen(context: AppContext, device_id: str) -> ServerSentEvent | None:
    """Record that the tablet is connected, and return its screen; None if it was unpaired."""
    with context.database.reading() as db:
        device = db.get(Device, device_id)
        if device is None or device.revoked_at is not None:
            return None
        context.hub.note_seen(device.id, context.clock.utc_now())
        state = tablet_state(db, session_by_id(db, device.session_id))
    return ServerSentEvent(data=state, event="state", id=str(state.version))


@calls.post("/sessions/{session_id}/help/answered", status_code=204)
def post_help_answered(session_id: str, db: Writing, context: Context, caller: SignedIn) -> None:
    """Record that somebody went to the participant, who called, had a question or wants to stop.

    The tablet or the headset then shows that, too.
    """
    session = session_by_id(db, session_id, lock=True)
    note_help(db, context, session, "answered")
    apply_command(db, context, session, CloseStop(outcome="answered"), actor=caller.actor)
    if may_ask(state_of(session)):
        closed = CloseQuestion(outcome="answered")
        apply_command(db, context, session, closed, actor=caller.actor)
