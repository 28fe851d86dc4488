"""The application without a network or waiting: simulated time and a socket that is a generator.

The application's own `HeadsetConnection` reads from a socket whose messages a test produces, and
its writer commits immediately. The server's clocks are those of `World`, so ten minutes offline
take no time.
"""

import asyncio
import json
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any, TypeVar, cast

from pydantic import SecretStr
from sqlalchemy import event, select
from starlette.websockets import WebSocket, WebSocketDisconnect, WebSocketState

from app.clock import Clock
from app.errors import NotNow, ReembodyError
from app.features.design.studies import add_shipped
from app.features.design.studies.service import create_study
from app.features.record.devices.service import new_code, pair
from app.features.record.headset.connection import HeadsetConnection
from app.features.record.sessions import apply_command, join, plan_of, state_of
from app.features.record.sessions import commands as c
from app.features.record.telemetry import TelemetryWriter
from app.features.record.telemetry.summaries import replace_rows, summary_rows
from app.features.record.telemetry.writer import Arrival, LossContent
from app.main import create_app
from app.models import Phase, StudySession
from app.platform.access import session_by_id
from app.platform.context import AppContext
from app.settings import Settings
from app.wire import MalformedBatchError

Json = dict[str, Any]
T = TypeVar("T")
TOGETHER = 20
LAST_TURNS = 60
"""Turns of the event loop in which the server answers the last messages before the line is cut."""


@dataclass
class World:
    """The server's simulated clocks: a monotonic one, and a wall clock that may be set."""

    monotonic_s: float = 5_000.0
    wall: datetime = datetime(2026, 3, 1, 9, tzinfo=UTC)

    def advance(self, seconds: float) -> None:
        """Advance both clocks."""
        self.monotonic_s += seconds
        self.wall += timedelta(seconds=seconds)

    @property
    def clock(self) -> Clock:
        """Return both clocks as one clock of the application."""
        return Clock(lambda: self.wall, lambda: round(self.monotonic_s * 1e9))


class PromptWriter(TelemetryWriter):
    """A writer that commits in the caller's thread: a group, or all arrivals on request."""

    def submit(self, arrival: Arrival) -> None:
        """Queue an arrival for the next commit; commit immediately if it reports a lost headset."""
        self._waiting.append(arrival)
        if len(self._waiting) >= TOGETHER or isinstance(arrival.content, LossContent):
            self.commit()

    def commit(self) -> None:
        """Store all pending arrivals."""
        arrivals, self._waiting = self._waiting, []
        if arrivals:
            self._store_or_wait(arrivals)


class PromptExecutor(ThreadPoolExecutor):
    """Do at once what the application leaves to a thread, so that no order depends on threads."""

    def submit(self, fn: Callable[..., T], /, *args: Any, **kwargs: Any) -> Future[T]:
        """Call the function in the caller's thread."""
        done = Future[T]()
        try:
            done.set_result(fn(*args, **kwargs))
        except Exception as error:  # noqa: BLE001 - a thread pool keeps every error, too
            done.set_exception(error)
        return done


@dataclass
class Socket:
    """The server's end of a socket: yields the headset's messages and collects the server's."""

    says: Iterator[Json | bytes | str]
    heard: list[Json] = field(default_factory=list)
    hangs_up: Callable[[], None] = lambda: None
    application_state: WebSocketState = WebSocketState.CONNECTED

    async def receive(self) -> Json:
        """Return the headset's next message, or a disconnect after its last one."""
        for _ in range(4):
            await asyncio.sleep(0)  # let the connection's other tasks run first
        said = next(self.says, None)
        if said is None:
            self.hangs_up()
            for _ in range(LAST_TURNS):
                await asyncio.sleep(0)
            return {"type": "websocket.disconnect", "code": 1000}
        if isinstance(said, bytes):
            return {"type": "websocket.receive", "bytes": said}
        text = said if isinstance(said, str) else json.dumps(said)
        return {"type": "websocket.receive", "text": text}

    async def send_text(self, text: str) -> None:
        """Record a message of the server."""
        self.heard.append(json.loads(text))

    async def close(self, code: int = 1000, reason: str = "") -> None:
        """Record that the server closed the connection."""
        self.heard.append({"type": "closed", "code": code, "reason": reason})


def _without_flushing(connection: Any, _record: object) -> None:
    connection.execute("PRAGMA synchronous=OFF")


@dataclass
class Site:
    """An application without a port, running on the clocks of `World`."""

    context: AppContext
    world: World
    writer: PromptWriter
    study: str

    @classmethod
    def open(cls, database_url: str, data_dir: Path, study_yaml: str, key: str) -> "Site":
        """Open an application on a migrated, empty database, with one study."""
        world = World()
        settings = Settings(
            database_url=database_url, data_dir=data_dir, admin_password=SecretStr("unused here")
        )
        context: AppContext = create_app(settings, clock=world.clock).state.context
        # These tests do not concern power losses, and flushing would take most of the time.
        event.listen(context.database.engine, "connect", _without_flushing)
        with context.database.writing() as db:
            add_shipped(db, context.clock.utc_now())
            create_study(db, study_yaml, context.clock.utc_now())
        writer = PromptWriter(context, lambda *_: None)
        return cls(context, world, writer, key)

    def join(self, *, kind: str = "test", time_scale: float = 1.0, step: str) -> str:
        """Create a session at this step, with its earlier steps skipped."""
        with self.context.database.writing() as db:
            session = join(
                db,
                self.context,
                study_key=self.study,
                participant_code=None,
                kind=kind,
                language="en",
                time_scale=time_scale,
            )
            apply_command(db, self.context, session, c.Start(), actor="test")
            while self._step(session) != step:
                words = c.ContentRef("0", "0")
                apply_command(db, self.context, session, c.Skip(content=words), actor="test")
            return session.id

    def command(self, session_id: str, command: c.Command) -> bool:
        """Apply an operator's command; return False if it is not possible now."""
        self.writer.commit()
        try:
            with self.context.database.writing() as db:
                session = session_by_id(db, session_id, lock=True)
                apply_command(db, self.context, session, command, actor="test")
        except NotNow:
            return False
        return True

    def _step(self, session: StudySession) -> str:
        with self.context.database.reading() as db:
            plan = plan_of(db, session)
        current = state_of(session).current
        return "" if current is None else plan[current].key

    def summarise(self, session_id: str) -> None:
        """Store the summaries that a running server computes in the background after a phase."""
        self.writer.commit()
        with self.context.database.writing() as db:
            done = select(Phase.phase_id).where(
                Phase.session_id == session_id, Phase.status == "done"
            )
            for phase_id in db.scalars(done).all():
                rows = summary_rows(db, session_id, phase_id)
                replace_rows(db, session_id, phase_id, rows)

    def token(self, session_id: str) -> str:
        """Pair a headset and return its token."""
        now = self.context.clock.utc_now()
        with self.context.database.writing() as db:
            code = new_code(db, session_id=session_id, kind="headset", now=now, minutes=10.0)
            return pair(db, code=code.code, name="simulated", now=now).token

    def connect(self, session_id: str, says: Iterator[Json | bytes | str], socket: Socket) -> None:
        """Run one connection of a headset until either side closes it; raise errors of the server.

        A rejection is in `socket.heard`, as the headset would receive it.
        """
        self.writer.commit()
        socket.says, socket.hangs_up = says, self.writer.commit
        token = self.token(session_id)

        async def serve() -> None:
            asyncio.get_running_loop().set_default_executor(PromptExecutor())
            asked = cast("WebSocket", socket)
            connection = HeadsetConnection(asked, self.context, self.writer, session_id, token)
            try:
                await connection.run()
            except (ReembodyError, MalformedBatchError) as error:
                socket.heard.append({"type": "closed", "code": 4400, "reason": str(error)})
            except WebSocketDisconnect:
                return

        asyncio.run(serve())
