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

from app.errors import Conflict, NotDurable, NotFound
from app.features.design.studies import create_study, study_by_key
from app.features.people.accounts import issue_token, revoke_purpose, revoke_token
from app.features.people.audit import record
from app.features.record.demo.demo_study import (
    DEMO_KEY,
    LOADED,
    OWN_CODES,
    PEOPLE,
    demo_code,
    demo_yaml,
    own_study,
    remove_study,
    require_only_simulated,
)
from app.features.record.sessions import apply_command, commands, store_content
from app.features.record.tryout import Performance
from app.models import Account, Participant, Study, StudySession
from app.platform.access import Caller, add_member, session_by_id
from app.platform.context import AppContext, Part

DemoState = Literal["absent", "loading", "loaded", "stopped", "failed"]
log = logging.getLogger(__name__)
SPEED = 40.0
"""Faster than most machines can: then they are as fast as they can."""
AT_ONCE = 3
"""People at the same time: their waiting for the server overlaps."""
HOURS = 2.0
PURPOSE = "demo"
"""Of the logins of simulated people: none of them outlives the server that issued it."""
INTERRUPTED = "The server stopped while the demo lab was being loaded."
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

    context: AppContext
    _loading: _Loading | None = None
    _lock: threading.RLock = field(default_factory=threading.RLock)

    @classmethod
    def of(cls, context: AppContext) -> Self:
        """Create the instance of a server from its context."""
        return cls(context)

    def start(self) -> None:
        """Revoke the logins of people who were on their way when the server ended."""
        with self.context.database.writing() as db:
            revoke_purpose(db, PURPOSE, self.context.clock.utc_now())

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
            now = self.context.clock.utc_now()
            with self.context.database.writing() as db:
                missing = _prepared(db, self.context, caller, now)
                account = db.get_one(Account, caller.account_id)
                token = issue_token(db, account, purpose=PURPOSE, now=now, hours=HOURS).token
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
        with self.context.database.reading() as db:
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
        with self.context.database.reading() as db:
            _removable(db, caller)
        self._end_visits()
        with self._lock:
            with self.context.database.writing() as db:
                study = _removable(db, caller)
                details = {"study": DEMO_KEY, **_counts(db, study)}
                rows = remove_study(db, study)
                record(
                    db,
                    actor=caller.actor,
                    action="demo.removed",
                    subject=DEMO_KEY,
                    details=details,
                    now=self.context.clock.utc_now(),
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
            with self.context.database.writing() as db:
                revoke_token(db, loading.token, self.context.clock.utc_now())
        except Exception:
            # The token expires anyway, and the server may be stopping.
            log.exception("the login of the simulated people could not be revoked")


def _prepared(db: Session, context: AppContext, caller: Caller, now: datetime) -> list[int]:
    """Make the study if it is missing; return the numbers of the people who have yet to come.

    Visits that an earlier loading broke off are ended first: nobody can come twice at once.
    """
    study = own_study(db, caller)
    if study is None:
        create_study(db, demo_yaml(), now)
        study = study_by_key(db, DEMO_KEY)
        add_member(db, caller, study)
        record(db, actor=caller.actor, action=LOADED, subject=DEMO_KEY, now=now)
    _end_broken_off(db, context, study, caller)
    through = _codes(db)
    return [number for number in range(1, PEOPLE + 1) if demo_code(number) not in through]


def _end_broken_off(db: Session, context: AppContext, study: Study, caller: Caller) -> None:
    """Abort the demo lab's own sessions that nobody goes on with, by commands on their record."""
    broken_off = db.scalars(
        select(StudySession.id)
        .join(Participant, Participant.id == StudySession.participant_id)
        .where(
            StudySession.study_id == study.id,
            StudySession.kind == "simulated",
            StudySession.status.in_(("planned", "active")),
            Participant.code.in_(OWN_CODES),
        )
        .order_by(StudySession.id)
    )
    for session_id in list(broken_off):
        session = session_by_id(db, session_id, lock=True)
        if session.status == "planned":
            # Only what has started can be ended.
            apply_command(db, context, session, commands.Start(), actor=caller.actor)
        reason = store_content(
            db,
            session_id=session.id,
            kind="reason",
            body=INTERRUPTED,
            by=caller.actor,
            now=context.clock.utc_now(),
        )
        stop = commands.Stop(status="aborted", content=reason)
        apply_command(db, context, session, stop, actor=caller.actor)


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
    """Return which of the demo lab's own people have completed their visit: others do not count."""
    return set(
        db.scalars(
            select(Participant.code)
            .join(StudySession, StudySession.participant_id == Participant.id)
            .join(Study, Study.id == StudySession.study_id)
            .where(
                Study.key == DEMO_KEY,
                StudySession.kind == "simulated",
                StudySession.status == "completed",
                Participant.code.in_(OWN_CODES),
            )
        )
    )
