"""Convert an operator's request into an engine command, and store the texts that come with it."""

from sqlalchemy.orm import Session

from app.errors import InvalidInput
from app.features.movement.avatar import configuration_by_hash
from app.features.record.cockpit.schemas import CommandRequest
from app.features.record.headset import feet_tracked
from app.features.record.preflight import overrides_of
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
from app.protocol import AvatarChanges, Step, settings_in_force
from app.science.avatar.configuration import AvatarSettingsError

_NEEDS_REASON = ("redo", "skip", "abort", "withdraw", "override_stop", "reopen_consent")
_STARTS = ("start", "begin_phase")
_OF_THE_BODY = ("change_avatar", "calibrate", "shift_tracker")
CENTIMETRES_PER_METRE = 100.0
_ENDS = ("pause", "skip", "complete_step", "abort", "withdraw")
"""Commands that end recording, so they are accepted even when the disk is full."""


def command_of(
    db: Session, context: AppContext, session: StudySession, request: CommandRequest, actor: str
) -> Command:
    """Convert a request into an engine command, and store its texts.

    Raises InvalidInput if a required text is missing, and NotDurable if the command would start
    something that cannot be stored.
    """
    _check_storage(context, request.type)
    reason = (request.reason or "").strip()
    if request.type in _NEEDS_REASON:
        require_reason(reason, request.type)
    store = _Store(db, context, session, actor)
    connected = context.hub.headset_connected(session.id)
    if request.type in _NEEDS_REASON:
        return _with_reason(request, store.put("reason", reason))
    if request.type in _OF_THE_BODY:
        return (
            _avatar_change(db, context, session, request, store)
            if request.type == "change_avatar"
            else _calibration(context, session, request, store)
        )
    match request.type:
        case "complete_step":
            content = _completion_content(store, request)
            return c.CompleteStep(by="operator", step=request.step_index, content=content)
        case "begin_phase":
            tracked = _feet_tracked(db, context, session)
            return c.BeginPhase(headset_connected=connected, feet_tracked=tracked)
        case "materialise":
            return c.Materialise(by="operator", headset_connected=connected)
        case "pause":
            # A second pause request adds no event that could refer to its reason.
            phase = state_of(session).phase
            new = bool(reason) and not (phase is not None and phase.pausing)
            return c.Pause(content=store.put("reason", reason) if new else None)
        case "resume":
            return c.Resume(headset_connected=connected)
        case "note":
            return c.AddNote(content=store.put("note", _note_text(request)))
        case _:
            return c.Start()


def _check_storage(context: AppContext, kind: str) -> None:
    if kind in _STARTS:
        context.storage.require_storage()
    if kind in _ENDS:
        context.storage.make_room()


def require_reason(reason: str, what: str) -> str:
    """Return a reason without surrounding spaces; raises InvalidInput if it is empty."""
    if not reason.strip():
        raise InvalidInput(
            f"{what} needs a reason",
            value=reason,
            valid="1 to 2000 characters",
            remedy="Give the reason in a few words; it becomes part of the record.",
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


def _feet_tracked(db: Session, context: AppContext, session: StudySession) -> bool | None:
    """Return whether the feet are measured; None if unknown, or overridden at the check of it."""
    return (
        None
        if "feet" in overrides_of(db, session.id)
        else feet_tracked(db, context.hub, session.id)
    )


def _calibration(
    context: AppContext, session: StudySession, request: CommandRequest, store: "_Store"
) -> Command:
    """Return the command that orders a calibration or a shift; a reason is optional."""
    reason = (request.reason or "").strip()
    content = store.put("reason", reason) if reason else None
    can = context.hub.headset_can(session.id, "calibrates")
    if request.type == "calibrate":
        return c.RequestCalibration(headset_can=can, content=content)
    shift = request.tracker_shift
    if shift is None:
        raise InvalidInput(
            "shift_tracker needs a shift",
            value=None,
            valid={"goal": "LeftHand", "right_cm": 1.0, "up_cm": 0.0, "back_cm": -2.0},
            remedy="Give the goal and its shift in tracker_shift.",
        )
    in_cm = (shift.right_cm, shift.up_cm, shift.back_cm)
    right_m, up_m, back_m = (round(one / CENTIMETRES_PER_METRE, 4) for one in in_cm)
    return c.ShiftTracker(
        goal=shift.goal, shift_m=(right_m, up_m, back_m), headset_can=can, content=content
    )


def _avatar_change(
    db: Session,
    context: AppContext,
    session: StudySession,
    request: CommandRequest,
    store: "_Store",
) -> Command:
    """Return the command that changes the avatar; raises InvalidInput if they do not fit.

    The changes must fit the configuration and the study's changes in the current phase.
    """
    # `CommandRequest` has seen to it that they are given.
    changes = request.avatar_changes or AvatarChanges()
    physics = session.avatar_configuration_hash
    before = state_of(session).avatar_changes
    if physics is not None:
        try:
            settings_in_force(configuration_by_hash(db, physics), changes)
        except AvatarSettingsError as error:
            first = error.problems[0]
            raise InvalidInput(
                f"avatar_changes.{first.path}: {first.message}",
                value=first.value,
                valid=first.valid,
                remedy=first.remedy,
                details=[vars(one) for one in error.problems],
            ) from error
    wanted = changes.as_json()
    reason = (request.reason or "").strip()
    is_new = wanted != ((before and before.operator) or {})
    return c.ChangeAvatar(
        changes=wanted,
        is_physics=physics is not None,
        headset_can=context.hub.headset_can(session.id, "changes_avatar"),
        content=store.put("reason", reason) if reason and is_new else None,
    )


def _completion_content(store: "_Store", request: CommandRequest) -> ContentRef | None:
    """Store the content of a completed step (a consent or heights), and return its reference."""
    step = store.current_step()
    late = step is not None and request.step_index not in (None, step.index)
    if step is not None and step.kind == "consent" and not late:
        return store.consents.from_operator(step, request.paper_consent)
    body = request.height_m.model_dump() if request.height_m else None
    return store.put("height", body) if body else None


class _Store:
    """Stores texts next to the event log, in the caller's transaction.

    If the command is rejected, the transaction is rolled back, so no text remains.
    """

    def __init__(self, db: Session, context: AppContext, session: StudySession, actor: str) -> None:
        self._db, self._context, self._session, self._actor = db, context, session, actor
        self.consents = ConsentDesk(db, context, session, actor)

    def current_step(self) -> Step | None:
        """Return the current step of the session, or None."""
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
