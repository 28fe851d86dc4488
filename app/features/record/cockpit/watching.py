"""Live updates of a session for the console, as server-sent events."""

import asyncio
from collections.abc import AsyncIterator
from typing import Annotated, Any

from fastapi import APIRouter, Depends, Request
from fastapi.sse import EventSourceResponse, ServerSentEvent

from app.errors import ReembodyError
from app.features.record.cockpit.view import session_view
from app.features.record.sessions import protocol_of_session
from app.platform.access import Caller, is_blind, session_by_id
from app.platform.background import Failing
from app.platform.context import AppContext
from app.platform.dependencies import Context, SignedIn, get_caller

router = APIRouter(tags=["sessions"])
HEARTBEAT_S = 10.0
RECHECK_S = 5.0
"""How often access is checked.

A login that is ended elsewhere is noticed immediately, one that expires within this time.
"""

SHOWN_BLINDED = frozenset({"phase_id", "active_s", "fps", "alarms"})
"""The live figures that do not depend on the latency."""
_ON_BEAT = "completions_on_beat"
_FLAGGED, _OWN_FLAGGED = "frames_flagged", "frames_flagged_of_participant"


def _existing_session(session_id: str, context: Context) -> str:
    """Return the session's id; raises NotFound before the stream has begun."""
    with context.database.reading() as db:
        return session_by_id(db, session_id).id


ExistingSession = Annotated[str, Depends(_existing_session)]


class Reader:
    """The reader of a live stream, who may lose access or be unblinded while reading."""

    def __init__(self, request: Request, context: AppContext, session_id: str) -> None:
        self._request, self._context, self._session_id = request, context, session_id
        self._checked_s = float("-inf")
        self.blinded = True

    async def has_access(self, *, now: bool = False) -> bool:
        """Return whether the reader still has access; queries the database every few seconds."""
        now_s = asyncio.get_running_loop().time()
        if not now and now_s - self._checked_s < RECHECK_S:
            return True
        self._checked_s = now_s
        return await asyncio.to_thread(self._check)

    def _check(self) -> bool:
        try:
            caller = get_caller(self._request, self._context)
        except ReembodyError:
            return False
        with self._context.database.reading() as db:
            session = session_by_id(db, self._session_id)
            self.blinded = is_blind(db, caller, protocol_of_session(db, session), session)
        return True

    async def session(self) -> ServerSentEvent:
        """Return the session as an event, without what this reader may not see."""
        return await asyncio.to_thread(self._session)

    def _session(self) -> ServerSentEvent:
        caller: Caller = get_caller(self._request, self._context)
        with self._context.database.reading() as db:
            session = session_by_id(db, self._session_id)
            view = session_view(db, self._context, session, caller)
        self.blinded = view.blinded
        return ServerSentEvent(data=view, event="session", id=str(view.version))


def _reader(request: Request, context: Context, _: SignedIn, session_id: ExistingSession) -> Reader:
    return Reader(request, context, session_id)


@router.get("/sessions/{session_id}/live", response_class=EventSourceResponse)
async def get_live(
    session_id: str, reader: Annotated[Reader, Depends(_reader)], context: Context
) -> AsyncIterator[ServerSentEvent]:
    """Stream live updates of a session until the login ends.

    Events: `session` on every change; `telemetry` a few times a second; `storage` at the start, and
    when the record can no longer be written or the disk is almost full; `background` when a
    background job fails or recovers.
    """
    with context.hub.subscribe(session_id, "telemetry") as subscription:
        news: dict[str, Any] = {"session": None}
        sent_storage, sent_failing = None, tuple[Failing, ...]()
        while await reader.has_access(now="access" in news):
            storage = await asyncio.to_thread(context.storage.state)
            if storage != sent_storage:
                yield ServerSentEvent(data=storage, event="storage")
                sent_storage = storage
            failing = context.background.failing()
            if failing != sent_failing:
                yield ServerSentEvent(data=failing, event="background")
                sent_failing = failing
            if "session" in news:
                try:
                    event = await reader.session()
                except ReembodyError:
                    return
                yield event
            if "telemetry" in news:
                figures = live_figures(news["telemetry"], blinded=reader.blinded)
                yield ServerSentEvent(data=figures, event="telemetry")
            news = await subscription.next(HEARTBEAT_S)
            if not news:
                yield ServerSentEvent(comment="still here")


def live_figures(figures: dict[str, Any], *, blinded: bool) -> dict[str, Any]:
    """Return the live figures that a reader may see.

    Joint errors grow with the latency, and a contact or a completed task follows the participant's
    movement by it. So blinded readers get neither joint errors nor side contacts nor the headset's
    time, and the number of completed tasks as of the last full 10 s of the phase only. How many of
    the avatar's frames are flagged depends on its settings: they get the participant's.
    """
    signal = {"signal": _signal(figures["signal"], blinded=blinded)} if "signal" in figures else {}
    if not blinded:
        return {name: value for name, value in figures.items() if name != _ON_BEAT} | signal
    shown = {name: value for name, value in figures.items() if name in SHOWN_BLINDED}
    return shown | signal | ({"completions": figures[_ON_BEAT]} if _ON_BEAT in figures else {})


def _signal(signal: dict[str, Any] | None, *, blinded: bool) -> dict[str, Any] | None:
    """Return the figures of the signal with one count of flagged frames, the reader's."""
    if signal is None:
        return None
    flagged = signal[_OWN_FLAGGED if blinded else _FLAGGED]
    return {name: value for name, value in signal.items() if name != _OWN_FLAGGED} | {
        _FLAGGED: flagged
    }
