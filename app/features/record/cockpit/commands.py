"""From an operator's request to an engine command, storing the words that come with it."""

from sqlalchemy.orm import Session

from app.errors import InvalidInput
from app.features.record.cockpit.schemas import CommandRequest
from app.features.record.sessions import (
    Command,
    ConsentDesk,
    ContentRef,
    plan_of,
    state_of,
    store_content,
)
from app.features.record.sessions import commands as c
from app.models import StudySession
from app.platform.context import AppContext
from app.protocol import Step

_NEEDS_REASON = ("redo", "skip", "abort", "withdraw", "override_stop", "reopen_consent")
_STARTS = ("start", "begin_phase")
_ENDS = ("pause", "skip", "complete_step", "abort", "withdraw")
"""What stops filling the disk: it is done on a full one, too."""


def command_of(
    db: Session, context: AppContext, session: StudySession, request: CommandRequest, actor: str
) -> Command:
    """The engine's command; raises InvalidInput where words are missing, and NotDurable where
    something would start that cannot be stored.
    """
    _look_at_storage(context, request.type)
    reason = (request.reason or "").strip()
    if request.type in _NEEDS_REASON:
        reason_given(reason, request.type)
    store = _Store(db, context, session, actor)
    connected = context.hub.headset_connected(session.id)
    if request.type in _NEEDS_REASON:
        return _with_reason(request, store.put("reason", reason))
    match request.type:
        case "complete_step":
            content = _completing(store, request)
            return c.CompleteStep(by="operator", step=request.step_index, content=content)
        case "begin_phase":
            return c.BeginPhase(headset_connected=connected)
        case "materialise":
            return c.Materialise(by="operator", headset_connected=connected)
        case "pause":
            # Asking again adds no event, so there would be nothing to hold the words.
            phase = state_of(session).phase
            new = bool(reason) and not (phase is not None and phase.pausing)
            return c.Pause(content=store.put("reason", reason) if new else None)
        case "resume":
            return c.Resume(headset_connected=connected)
        case "note":
            return c.AddNote(content=store.put("note", _note_text(request)))
        case _:
            return c.Start()


def _look_at_storage(context: AppContext, kind: str) -> None:
    if kind in _STARTS:
        context.storage.require_storage()
    if kind in _ENDS:
        context.storage.make_room()


def reason_given(reason: str, what: str) -> str:
    """The words of a reason; raises InvalidInput where there are none."""
    if not reason.strip():
        raise InvalidInput(
            f"{what} needs a reason",
            value=reason,
            valid="1 to 2000 characters",
            remedy="Write in a few words why; it becomes part of the record.",
        )
    return reason.strip()


def _with_reason(request: CommandRequest, reason: ContentRef) -> Command:
    match request.type:
        case "redo":
            return c.Redo(content=reason, step=request.step_index)
        case "skip":
            return c.Skip(content=reason)
        case "override_stop":
            return c.OverrideStop(content=reason)
        case "reopen_consent":
            return c.RetractRefusal(by="operator", content=reason)
        case "abort":
            return c.Stop(status="aborted", content=reason)
        case _:
            return c.Stop(status="withdrawn", content=reason)


def _completing(store: "_Store", request: CommandRequest) -> ContentRef | None:
    """What comes with a step that is done: a consent's record, or the heights."""
    step = store.current_step()
    late = step is not None and request.step_index not in (None, step.index)
    if step is not None and step.kind == "consent" and not late:
        return store.consents.from_operator(step, request.paper_consent)
    body = request.height_m.model_dump() if request.height_m else None
    return store.put("height", body) if body else None


class _Store:
    """Puts words beside the log, in the caller's transaction: a refusal leaves none behind."""

    def __init__(self, db: Session, context: AppContext, session: StudySession, actor: str) -> None:
        self._db, self._context, self._session, self._actor = db, context, session, actor
        self.consents = ConsentDesk(db, context, session, actor)

    def current_step(self) -> Step | None:
        """The step that the session stands at, if it stands anywhere."""
        current = state_of(self._session).current
        return None if current is None else plan_of(self._db, self._session)[current]

    def put(self, kind: str, body: object) -> ContentRef:
        return store_content(
            self._db,
            session_id=self._session.id,
            kind=kind,
            body=body,
            by=self._actor,
            now=self._context.clock.utc_now(),
        )


def _note_text(request: CommandRequest) -> str:
    text = (request.text or "").strip()
    if not text:
        raise InvalidInput(
            "a note needs some text", value=request.text, remedy="Write the note, then send it."
        )
    return text
