"""Live news of a session for the console, as server-sent events."""

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
LOOK_AGAIN_S = 5.0
"""A login that was ended elsewhere is noticed at once, one that expires within this time."""


def _known_session(session_id: str, context: Context) -> str:
    """The id of a session that exists: a stream cannot say otherwise once it has begun."""
    with context.database.reading() as db:
        return session_by_id(db, session_id).id


KnownSession = Annotated[str, Depends(_known_session)]


class Reader:
    """Who reads a stream, as they are now: they may be shut out, or unblinded, while they read."""

    def __init__(self, request: Request, context: AppContext, session_id: str) -> None:
        self._request, self._context, self._session_id = request, context, session_id
        self._looked_s = float("-inf")
        self.blinded = True

    async def may_go_on(self, *, now: bool = False) -> bool:
        """Whether the login still opens this session; asks the database every few seconds."""
        looked_s = asyncio.get_running_loop().time()
        if not now and looked_s - self._looked_s < LOOK_AGAIN_S:
            return True
        self._looked_s = looked_s
        return await asyncio.to_thread(self._look)

    def _look(self) -> bool:
        try:
            caller = get_caller(self._request, self._context)
        except ReembodyError:
            return False
        with self._context.database.reading() as db:
            session = session_by_id(db, self._session_id)
            self.blinded = is_blind(db, caller, protocol_of_session(db, session), session)
        return True

    async def session(self) -> ServerSentEvent:
        """The session as this reader may see it."""
        return await asyncio.to_thread(self._session)

    def _session(self) -> ServerSentEvent:
        caller: Caller = get_caller(self._request, self._context)
        with self._context.database.reading() as db:
            session = session_by_id(db, self._session_id)
            view = session_view(db, self._context, session, caller)
        self.blinded = view.blinded
        return ServerSentEvent(data=view, event="session", id=str(view.version))


def _reader(request: Request, context: Context, _: SignedIn, session_id: KnownSession) -> Reader:
    return Reader(request, context, session_id)


@router.get("/sessions/{session_id}/live", response_class=EventSourceResponse)
async def get_live(
    session_id: str, reader: Annotated[Reader, Depends(_reader)], context: Context
) -> AsyncIterator[ServerSentEvent]:
    """News of a session: `session` on every change, `telemetry` a few times a second, and
    `storage` at first and when the record ceases to be written, or the disk gets low, and
    `background` when something that runs beside the requests fails or works again.

    Ends when the login does.
    """
    with context.hub.subscribe(session_id, "telemetry") as subscription:
        news: dict[str, Any] = {"session": None}
        told, failing_before = None, tuple[Failing, ...]()
        while await reader.may_go_on(now="access" in news):
            storage = await asyncio.to_thread(context.storage.state)
            if storage != told:
                yield ServerSentEvent(data=storage, event="storage")
                told = storage
            failing = context.background.failing()
            if failing != failing_before:
                yield ServerSentEvent(data=failing, event="background")
                failing_before = failing
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
    """What a reader sees; joint errors grow with the latency, so they would tell the condition."""
    if not blinded:
        return figures
    return {name: value for name, value in figures.items() if name != "joint_error_deg"}
