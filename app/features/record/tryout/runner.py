"""Start and stop scripted participants: one at a time, simulated, and ended with the server."""

import logging
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Annotated, Any, Literal, Self

from pydantic import BaseModel, ConfigDict, StringConstraints

from app.clock import Clock
from app.database import Database
from app.errors import Conflict, NotDurable, NotFound
from app.features.people.accounts import issue_token, revoke_purpose, revoke_token
from app.features.record.tryout.performance import Performance
from app.models import Account
from app.platform.access import Caller
from app.platform.context import AppContext, Part

TryoutState = Literal["starting", "running", "done", "stopped", "failed"]


class TryoutWish(BaseModel):
    """A request to start a scripted participant, with the language in which it answers."""

    model_config = ConfigDict(extra="forbid")

    language: Annotated[str, StringConstraints(min_length=2, max_length=8)]


class TryoutTrouble(BaseModel):
    """The reason why a scripted participant ended early, and the remedy."""

    message: str
    remedy: str


class TryoutView(BaseModel):
    """The latest scripted participant.

    `session_id` is null until its session is created; `step` is the step it has reached. `speed`:
    how many times faster than a person. `mine`: whether the reader started it.
    """

    state: TryoutState
    study_key: str
    session_id: str | None
    step: str | None
    speed: float
    started_at: datetime
    started_by: str
    mine: bool
    trouble: TryoutTrouble | None


log = logging.getLogger(__name__)
SPEED = 4.0
"""Slow enough to follow: a session of a quarter of an hour takes four minutes."""
HOURS = 2.0
PURPOSE = "tryout"
"""Of the logins of scripted participants: none of them outlives the server that issued it."""
MAX_STEP_LENGTH = 120
BROKE_OFF = TryoutTrouble(
    message="the scripted participant ended unexpectedly",
    remedy="Open the session to see how far it got, and start another one.",
)


@dataclass(eq=False)
class Tryout:
    """A run of a scripted participant. `token` is its login token, revoked at the end."""

    by: Caller
    study_key: str
    token: str
    started_at: datetime
    state: TryoutState = "starting"
    session_id: str | None = None
    step: str | None = None
    trouble: TryoutTrouble | None = None
    performance: Performance | None = None

    @property
    def is_on(self) -> bool:
        """Return whether the process of the scripted participant is running."""
        return self.state in ("starting", "running")


@dataclass(eq=False)
class TryoutRunner(Part):
    """Starts, stops and reports the scripted participants of a server; thread-safe."""

    database: Database
    clock: Clock
    speed: float = SPEED
    _newest: Tryout | None = None
    _lock: threading.RLock = field(default_factory=threading.RLock)

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the instance of a server from its context."""
        return cls(context.database, context.clock)

    def start(self) -> None:
        """Revoke the login of somebody who was performing when the server ended."""
        with self.database.writing() as db:
            revoke_purpose(db, PURPOSE, self.clock.utc_now())

    def begin(self, caller: Caller, study_key: str, language: str, url: str) -> TryoutView:
        """Send a scripted participant through a study at `url`; raises Conflict, NotDurable."""
        with self._lock:
            if self._newest is not None and self._newest.is_on:
                raise Conflict(
                    "a scripted participant is already running",
                    value=self._newest.by.username,
                    valid="one at a time",
                    remedy="Watch it, or stop it first.",
                )
            now = self.clock.utc_now()
            tryout = Tryout(caller, study_key, self._token(caller, now), now)
            plan = {
                "url": url,
                "study": study_key,
                "speed": self.speed,
                "seed": now.microsecond,
                "token": tryout.token,
                "language": language,
            }
            tryout.performance = Performance(
                plan,
                lambda message: self._handle_output(tryout, message),
                lambda: self._ended(tryout),
            )
            self._newest = tryout
            try:
                tryout.performance.start()
            except OSError as error:
                self._fail(tryout, str(error))
                self._revoke(tryout)
                raise NotDurable(
                    "the scripted participant could not be started",
                    value=str(error),
                    remedy="The server cannot start another process at the moment; try later.",
                ) from error
            return _view(tryout, caller)

    def newest(self, caller: Caller) -> TryoutView | None:
        """Return the latest scripted participant, or None if the server has not started any."""
        with self._lock:
            return None if self._newest is None else _view(self._newest, caller)

    def call_off(self, caller: Caller) -> TryoutView:
        """Stop the scripted participant and end its session; raises NotFound if none is running."""
        with self._lock:
            tryout = self._newest
            if tryout is None or not tryout.is_on:
                raise NotFound("no scripted participant is running", remedy="Start another one.")
            tryout.state = "stopped"
        if tryout.performance is not None:
            tryout.performance.stop()
        return _view(tryout, caller)

    def stop(self) -> None:
        """Kill the scripted participant when the server stops."""
        with self._lock:
            tryout = self._newest
            if tryout is None or not tryout.is_on:
                return
            tryout.state = "stopped"
        # It can no longer end its session, because the server does not answer any more.
        if tryout.performance is not None:
            tryout.performance.kill()

    def _handle_output(self, tryout: Tryout, message: Mapping[str, Any]) -> None:
        with self._lock:
            if not tryout.is_on:
                return
            if "session" in message:
                tryout.session_id, tryout.state = str(message["session"]), "running"
            if "step" in message:
                tryout.step = str(message["step"])[:MAX_STEP_LENGTH]
            if "done" in message:
                tryout.state = "done"
            if "error" in message:
                self._fail(tryout, str(message["error"]))

    def _ended(self, tryout: Tryout) -> None:
        with self._lock:
            if tryout.is_on:
                tryout.state, tryout.trouble = "failed", BROKE_OFF
        self._revoke(tryout)

    def _fail(self, tryout: Tryout, why: str) -> None:
        log.warning("the scripted participant failed: %s", why)
        tryout.state = "failed"
        tryout.trouble = TryoutTrouble(
            message=why,
            remedy="Fix the cause and start another one; no data of people were changed.",
        )

    def _token(self, caller: Caller, now: datetime) -> str:
        with self.database.writing() as db:
            account = db.get_one(Account, caller.account_id)
            return issue_token(db, account, purpose=PURPOSE, now=now, hours=HOURS).token

    def _revoke(self, tryout: Tryout) -> None:
        try:
            with self.database.writing() as db:
                revoke_token(db, tryout.token, self.clock.utc_now())
        except Exception:
            # The token expires anyway, and the server may be stopping.
            log.exception("the login of the scripted participant could not be revoked")


def _view(tryout: Tryout, reader: Caller) -> TryoutView:
    return TryoutView(
        state=tryout.state,
        study_key=tryout.study_key,
        session_id=tryout.session_id,
        step=tryout.step,
        speed=SPEED,
        started_at=tryout.started_at,
        started_by=tryout.by.username,
        mine=tryout.by.account_id == reader.account_id,
        trouble=tryout.trouble,
    )
