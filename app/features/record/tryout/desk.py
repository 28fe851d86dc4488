"""The tryout of this server: one at a time, marked as simulated, ended with the server."""

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
from app.features.people.accounts import issue_token, revoke_token
from app.features.record.tryout.performance import Performance
from app.models import Account
from app.platform.access import Caller
from app.platform.context import AppContext, Part

TryoutState = Literal["starting", "running", "done", "stopped", "failed"]


class TryoutWish(BaseModel):
    """In which language the scripted participant answers."""

    model_config = ConfigDict(extra="forbid")

    language: Annotated[str, StringConstraints(min_length=2, max_length=8)]


class TryoutTrouble(BaseModel):
    """Why it ended early, and what to do about it."""

    message: str
    remedy: str


class TryoutView(BaseModel):
    """The newest tryout. `session_id` is there once the session is; `step` says where it is.

    `speed`: how many times faster than a person. `mine`: whether the reader began it.
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
"""As fast as everything can still be followed: a session of a quarter of an hour takes four."""
HOURS = 2.0
LONGEST_STEP = 120
BROKE_OFF = TryoutTrouble(
    message="the scripted participant ended without a word",
    remedy="Look at the session for how far it came, and begin again.",
)


@dataclass(eq=False)
class Tryout:
    """One of them. `token` is what its devices sign in with, revoked at the end."""

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
        """Whether its process runs."""
        return self.state in ("starting", "running")


@dataclass(eq=False)
class TryoutDesk(Part):
    """Safe from any thread; remembers the newest tryout."""

    database: Database
    clock: Clock
    speed: float = SPEED
    _newest: Tryout | None = None
    _lock: threading.RLock = field(default_factory=threading.RLock)

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """The tryouts of a server."""
        return cls(context.database, context.clock)

    def begin(self, caller: Caller, study_key: str, language: str, url: str) -> TryoutView:
        """Send a scripted participant through a study at `url`; raises Conflict, NotDurable."""
        with self._lock:
            if self._newest is not None and self._newest.is_on:
                raise Conflict(
                    "a scripted participant is here already",
                    value=self._newest.by.username,
                    valid="one at a time",
                    remedy="Watch that one, or stop it first.",
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
                plan, lambda news: self._heard(tryout, news), lambda: self._ended(tryout)
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
                    remedy="The server's machine has no room for another process; try later.",
                ) from error
            return _view(tryout, caller)

    def newest(self, caller: Caller) -> TryoutView | None:
        """How the newest one is doing; None where there was none since the server started."""
        with self._lock:
            return None if self._newest is None else _view(self._newest, caller)

    def call_off(self, caller: Caller) -> TryoutView:
        """End it and its session. Raises NotFound where none is running."""
        with self._lock:
            tryout = self._newest
            if tryout is None or not tryout.is_on:
                raise NotFound("no scripted participant is here", remedy="Begin another.")
            tryout.state = "stopped"
        if tryout.performance is not None:
            tryout.performance.stop()
        return _view(tryout, caller)

    def stop(self) -> None:
        """With the server."""
        with self._lock:
            tryout = self._newest
            if tryout is None or not tryout.is_on:
                return
            tryout.state = "stopped"
        # It could not end its session any more: nobody answers now.
        if tryout.performance is not None:
            tryout.performance.kill()

    def _heard(self, tryout: Tryout, news: Mapping[str, Any]) -> None:
        with self._lock:
            if not tryout.is_on:
                return
            if "session" in news:
                tryout.session_id, tryout.state = str(news["session"]), "running"
            if "step" in news:
                tryout.step = str(news["step"])[:LONGEST_STEP]
            if "done" in news:
                tryout.state = "done"
            if "error" in news:
                self._fail(tryout, str(news["error"]))

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
            remedy="Put it right and begin again; nothing of people's data was touched.",
        )

    def _token(self, caller: Caller, now: datetime) -> str:
        with self.database.writing() as db:
            account = db.get_one(Account, caller.account_id)
            return issue_token(db, account, purpose="script", now=now, hours=HOURS).token

    def _revoke(self, tryout: Tryout) -> None:
        try:
            with self.database.writing() as db:
                revoke_token(db, tryout.token, self.clock.utc_now())
        except Exception:
            # It expires by itself; the server may be ending.
            log.exception("the login of the scripted participant was not revoked")


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
