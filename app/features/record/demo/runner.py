"""Load the demo lab: a study and twelve simulated people, who visit it in a process of their own.

They come over the same interfaces as any device, so what they leave is a record like any other:
events, answers, movement and receipts, marked as simulated.
"""

import logging
import sys
import threading
from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import datetime
from typing import Any, Literal, Self

from pydantic import BaseModel
from sqlalchemy import func, select
from sqlalchemy.orm import Session

from app.clock import Clock
from app.database import Database
from app.errors import Conflict, NotDurable, NotFound
from app.features.design.studies import create_study, study_by_key
from app.features.people.accounts import issue_token, revoke_token
from app.features.people.audit import record
from app.features.record.demo.demo_study import (
    DEMO_KEY,
    LOADED,
    PEOPLE,
    demo_code,
    demo_yaml,
    own_study,
    remove_study,
    require_only_simulated,
)
from app.features.record.tryout import Performance
from app.models import Account, Participant, Study, StudySession
from app.platform.access import Caller, add_member
from app.platform.context import AppContext, Part

DemoState = Literal["absent", "loading", "loaded", "stopped", "failed"]
log = logging.getLogger(__name__)
SPEED = 40.0
"""Faster than most machines can: then they are as fast as they can."""
AT_ONCE = 3
"""People at the same time: their waiting for the server overlaps."""
HOURS = 2.0
SEVERAL = (sys.executable, "-m", "app.rehearsal.several")
BROKE_OFF = "The simulated people ended unexpectedly."
REMEDY = "Load the demo lab again for those who are missing, or remove it."


class DemoView(BaseModel):
    """The demo lab: how many of its simulated people are through.

    `state`: `loading` while they are on their way; `stopped` if some are missing, because the
    server stopped or somebody ended it; `failed` if they could not go on, with the reason;
    `absent` with a `message` if it cannot be loaded here.
    """

    state: DemoState
    study_key: str
    people: int
    completed: int
    message: str | None
    remedy: str | None


@dataclass(eq=False)
class _Loading:
    """Simulated people who are on their way, with the login that they use."""

    token: str
    performance: Performance | None = None
    running: bool = True
    message: str | None = None


@dataclass(eq=False)
class DemoRunner(Part):
    """Loads, reports and removes the demo lab of a server; thread-safe."""

    database: Database
    clock: Clock
    _loading: _Loading | None = None
    _lock: threading.RLock = field(default_factory=threading.RLock)

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the instance of a server from its context."""
        return cls(context.database, context.clock)

    def load(self, caller: Caller, language: str, url: str) -> DemoView:
        """Make the study if it is missing, and send those who have not been there yet.

        Raises Conflict while they are on their way or if the study with the demo lab's key is not
        its own, NotDurable if no process can be started.
        """
        with self._lock:
            if self._is_loading:
                raise Conflict(
                    "the demo lab is being loaded already",
                    value=DEMO_KEY,
                    valid="one at a time",
                    remedy="Wait for it, or stop it by removing it.",
                )
            now = self.clock.utc_now()
            with self.database.writing() as db:
                missing = _prepared(db, caller, now)
                account = db.get_one(Account, caller.account_id)
                token = issue_token(db, account, purpose="script", now=now, hours=HOURS).token
            loading = _Loading(token)
            plans = [
                {
                    "url": url,
                    "study": DEMO_KEY,
                    "speed": SPEED,
                    "seed": number,
                    "token": token,
                    "language": language,
                    "participant_code": demo_code(number),
                }
                for number in missing
            ]
            loading.performance = Performance(
                {"at_once": AT_ONCE, "plans": plans},
                lambda news: self._hear(loading, news),
                lambda: self._ended(loading),
                SEVERAL,
            )
            self._loading = loading
            try:
                loading.performance.start()
            except OSError as error:
                loading.running, loading.message = False, str(error)
                self._revoke(loading)
                raise NotDurable(
                    "the simulated people could not be started",
                    value=str(error),
                    remedy="The server cannot start another process at the moment; try later.",
                ) from error
        return self.view(caller)

    def view(self, caller: Caller) -> DemoView:
        """Return how far the demo lab is loaded; absent, with the reason, if it is impossible."""
        with self._lock:
            loading, running = self._loading, self._is_loading
        with self.database.reading() as db:
            try:
                exists = own_study(db, caller) is not None
            except Conflict as refusal:
                return DemoView(
                    state="absent",
                    study_key=DEMO_KEY,
                    people=PEOPLE,
                    completed=0,
                    message=refusal.message,
                    remedy=refusal.remedy,
                )
            completed = len(_codes(db))
        message = None if loading is None or running else loading.message
        state: DemoState = (
            "loading"
            if running
            else "absent"
            if not exists
            else "loaded"
            if completed >= PEOPLE
            else "failed"
            if message is not None
            else "stopped"
        )
        return DemoView(
            state=state,
            study_key=DEMO_KEY,
            people=PEOPLE,
            completed=completed,
            message=message if state == "failed" else None,
            remedy=REMEDY if state in ("failed", "stopped") else None,
        )

    def remove(self, caller: Caller) -> int:
        """Stop those who are on their way, and delete the study with all of its rows.

        Returns the number of deleted rows; raises NotFound if there is no demo lab, and Conflict if
        the study is not its own or has sessions that it did not make.
        """
        with self.database.reading() as db:
            _removable(db, caller)
        self._end_visits()
        with self._lock:
            with self.database.writing() as db:
                study = _removable(db, caller)
                details = {"study": DEMO_KEY, **_counts(db, study)}
                rows = remove_study(db, study)
                record(
                    db,
                    actor=caller.actor,
                    action="demo.removed",
                    subject=DEMO_KEY,
                    details=details,
                    now=self.clock.utc_now(),
                )
            self._loading = None
        return rows

    def stop(self) -> None:
        """Kill those who are on their way when the server stops; what they have recorded stays."""
        loading = self._loading
        if loading is not None and loading.performance is not None:
            loading.running = False
            loading.performance.kill()

    def _end_visits(self) -> None:
        """Let those who are on their way end their sessions, so that nothing more arrives."""
        loading = self._loading
        if loading is None or loading.performance is None:
            return
        if loading.running:
            loading.running = False
            loading.performance.stop()
        loading.performance.kill()

    @property
    def _is_loading(self) -> bool:
        return self._loading is not None and self._loading.running

    def _hear(self, loading: _Loading, news: Mapping[str, Any]) -> None:
        with self._lock:
            if "done" in news:
                loading.running = False
            if "error" in news:
                loading.running, loading.message = False, str(news["error"])

    def _ended(self, loading: _Loading) -> None:
        with self._lock:
            if loading.running:
                loading.running, loading.message = False, BROKE_OFF
        self._revoke(loading)

    def _revoke(self, loading: _Loading) -> None:
        try:
            with self.database.writing() as db:
                revoke_token(db, loading.token, self.clock.utc_now())
        except Exception:
            # The token expires anyway, and the server may be stopping.
            log.exception("the login of the simulated people could not be revoked")


def _prepared(db: Session, caller: Caller, now: datetime) -> list[int]:
    """Make the study if it is missing; return the numbers of the people who have yet to come."""
    study = own_study(db, caller)
    if study is None:
        create_study(db, demo_yaml(), now)
        study = study_by_key(db, DEMO_KEY)
        add_member(db, caller, study)
        record(db, actor=caller.actor, action=LOADED, subject=DEMO_KEY, now=now)
    through = _codes(db)
    return [number for number in range(1, PEOPLE + 1) if demo_code(number) not in through]


def _removable(db: Session, caller: Caller) -> Study:
    """Return the demo lab's study if it may be removed; raise NotFound or Conflict otherwise."""
    study = own_study(db, caller)
    if study is None:
        raise NotFound("there is no demo lab", remedy="Load it first.")
    require_only_simulated(db, study)
    return study


def _counts(db: Session, study: Study) -> dict[str, int]:
    """Return how many participants and sessions a study has."""
    sessions, participants = db.execute(
        select(
            func.count(StudySession.id), func.count(StudySession.participant_id.distinct())
        ).where(StudySession.study_id == study.id)
    ).one()
    return {"participants": participants, "sessions": sessions}


def _codes(db: Session) -> set[str]:
    """Return the codes of the simulated people who have completed their visit."""
    return set(
        db.scalars(
            select(Participant.code)
            .join(StudySession, StudySession.participant_id == Participant.id)
            .join(Study, Study.id == StudySession.study_id)
            .where(
                Study.key == DEMO_KEY,
                StudySession.kind == "simulated",
                StudySession.status == "completed",
            )
        )
    )
