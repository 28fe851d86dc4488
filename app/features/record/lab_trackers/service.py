"""Follow the sessions that use the lab's trackers: align, store, and wake the headset's socket.

Three threads meet here: that of a door brings samples, the event loop serves the headset's socket,
and one of ours looks once a second after the alignment, the storing, and what was chosen since.
"""

import logging
import threading
from collections import deque
from collections.abc import Callable, Sequence
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import partial

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import NotFound
from app.features.movement.live import LiveTracking, Sample, limbs_of
from app.features.movement.performers import Performers
from app.features.record.headset import Waiting, is_kept, recording_of
from app.features.record.lab_trackers.bones import bone_limbs
from app.features.record.lab_trackers.link import TrackerLink
from app.features.record.lab_trackers.recording import (
    MAX_WAITING,
    store_change,
    store_samples,
)
from app.features.record.lab_trackers.worker_tasks import WatchStep, watch_step
from app.features.record.sessions import state_of
from app.models import StudySession
from app.platform.access import session_by_id
from app.platform.context import AppContext, Part
from app.platform.workers import Worker
from app.science.alignment import Watched
from app.wire import HeadPose

log = logging.getLogger(__name__)
THREAD = "lab-trackers"
EVERY_S = 1.0
Wake = Callable[[], None]


@dataclass(eq=False)
class Followed:
    """A session that uses trackers: its link, what waits for the disk, and who is to be woken."""

    session_id: str
    link: TrackerLink
    waiting: Waiting[Sample] = field(default_factory=lambda: Waiting(MAX_WAITING))
    changes: deque[Watched] = field(default_factory=deque)
    storing: threading.Lock = field(default_factory=threading.Lock)
    was_recording: bool = False
    is_watching: bool = False
    refits: int = 0
    jumps: int = 0


class LabTrackers(Part):
    """The links of all sessions that use the lab's trackers."""

    def __init__(self, context: AppContext) -> None:
        self._context = context
        self._followed: dict[str, Followed] = {}
        self._leaving: list[Followed] = []
        self._wakes: dict[str, Wake] = {}
        self._worker = Worker().watched_by(context.background, "tracker-alignment")
        self._lock = threading.RLock()
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Follow the sessions that used trackers when the server was stopped."""
        with self._context.database.reading() as db:
            rows = db.scalars(
                select(StudySession).where(StudySession.status.in_(("planned", "active")))
            )
            chosen = [row.id for row in rows if row.snapshot.get("trackers") is not None]
        for session_id in chosen:
            self.follow(session_id)
        self._context.part(LiveTracking).add_follower(self._take)
        self._thread = self._context.background.thread(THREAD, self._run, critical=True)

    def stop(self) -> None:
        """Store what waits, and end."""
        self._context.part(LiveTracking).remove_follower(self._take)
        self._stopping.set()
        if self._thread is not None:
            self._thread.join()
        self._worker.end()

    def follow(self, session_id: str) -> None:
        """Use the trackers that are chosen for a session now, or none."""
        with self._context.database.reading() as db:
            chosen = state_of(session_by_id(db, session_id)).trackers
            limbs, bones = {}, {}
            if chosen is not None:
                limbs = limbs_of(db, chosen.door, chosen.source)
                bones = bone_limbs(db, self._context.part(Performers), chosen.door, chosen.source)
        with self._lock:
            before = self._followed.get(session_id)
            if chosen is None:
                # What it sent until now is stored with the next look.
                if before is not None:
                    self._leaving.append(self._followed.pop(session_id))
            elif before is None or (before.link.door, before.link.source) != (
                chosen.door,
                chosen.source,
            ):
                link = TrackerLink(chosen.door, chosen.source)
                new = Followed(session_id, link)
                if before is not None:
                    new.waiting, new.was_recording = before.waiting, before.was_recording
                self._followed[session_id] = new
                link.wear(limbs, bones)
            else:
                before.link.wear(limbs, bones)
        self._wake(session_id)

    def store_now(self, session_id: str) -> None:
        """Store what a session's trackers brought; call it before they are changed.

        An alignment that still waits would otherwise be one of trackers that are not chosen. What
        cannot be stored now waits on: nobody is kept from giving trackers up.
        """
        followed = self.followed(session_id)
        if followed is None:
            return
        try:
            self._store(followed)
        except Exception as error:
            log.exception("the trackers of session %s could not be stored", session_id)
            self._context.background.failed(THREAD, error)

    def followed(self, session_id: str) -> Followed | None:
        """Return what is known of a session's trackers; None if it uses none."""
        with self._lock:
            return self._followed.get(session_id)

    def attach(self, session_id: str, wake: Wake) -> None:
        """Wake the socket of a session's headset on news; the newest socket replaces others."""
        with self._lock:
            before = self._wakes.get(session_id)
            self._wakes[session_id] = wake
            followed = self._followed.get(session_id)
        if followed is not None:
            followed.link.begin_run()
        if before is not None:
            before()

    def is_attached(self, session_id: str, wake: Wake) -> bool:
        """Return whether this is still the newest socket of a session's headset."""
        with self._lock:
            return self._wakes.get(session_id) is wake

    def detach(self, session_id: str, wake: Wake) -> None:
        """Wake this socket no more."""
        with self._lock:
            if self._wakes.get(session_id) is wake:
                del self._wakes[session_id]

    def take_head(self, session_id: str, poses: Sequence[HeadPose]) -> None:
        """Take where a session's headset says that its wearer's head was."""
        followed = self.followed(session_id)
        if followed is not None:
            followed.waiting.add(followed.link.take_head(poses, self._now_s()))

    def _take(self, samples: Sequence[Sample]) -> None:
        """Take samples in the thread of a door."""
        with self._lock:
            followed = tuple(self._followed.values())
        for one in followed:
            own = [each for each in samples if is_from(each, one.link)]
            if not own:
                continue
            one.waiting.add(own)
            moved = [one.link.take(each) for each in own if not each.is_late]
            if any(moved):
                self._wake(one.session_id)

    def _wake(self, session_id: str) -> None:
        wake = self._wakes.get(session_id)
        if wake is not None:
            wake()

    def _run(self) -> None:
        while not self._stopping.wait(EVERY_S):
            self._look_after_all()
        self._look_after_all(is_last=True)

    def _look_after_all(self, *, is_last: bool = False) -> None:
        with self._lock:
            followed = tuple(self._followed.values())
            leaving, self._leaving = self._leaving, []
        for one in (*leaving, *followed):
            try:
                self._store(one)
                if one in followed and not is_last:
                    self.follow(one.session_id)
                    self._watch(one)
            except NotFound:
                # Its study was deleted as a whole, the demo lab's, so nobody misses what waits.
                self._forget(one)
            except Exception as error:
                # Reported here, so that it keeps no other session from being stored.
                log.exception("the trackers of session %s could not be stored", one.session_id)
                self._context.background.failed(THREAD, error)
                if one in leaving:
                    with self._lock:
                        self._leaving.append(one)

    def _forget(self, one: Followed) -> None:
        with self._lock:
            if self._followed.get(one.session_id) is one:
                del self._followed[one.session_id]

    def _watch(self, one: Followed) -> None:
        """Have the worker look at the newest half minute, unless it still looks at the last."""
        if one.is_watching:
            return
        due = one.link.to_watch(self._now_s())
        if due is None:
            return
        number, watched, headset, tracker = due
        one.is_watching = True
        done = self._worker.submit(watch_step, watched, headset, tracker)
        done.add_done_callback(partial(self._watched, one, number))

    def _watched(self, one: Followed, number: int, done: "Future[WatchStep]") -> None:
        one.is_watching = False
        if done.cancelled() or done.exception() is not None:
            return  # the worker's own watch reports it; the next second tries again
        step = done.result()
        if not one.link.take_step(number, step):
            return
        change = step.watched.change
        if change is not None:
            one.refits += change == "refit"
            one.jumps += change in ("lost", "moved")
            one.changes.append(step.watched)
            self._wake(one.session_id)

    def _store(self, one: Followed) -> None:
        """Store what waits in a transaction; if that fails, raise the error, and it waits on."""
        with one.storing:
            self._store_alone(one)

    def _store_alone(self, one: Followed) -> None:
        with self._context.database.reading() as db:
            recording = recording_of(db, session_by_id(db, one.session_id))
        samples, changes = one.waiting.take(), list(one.changes)
        was_recorded = is_kept(recording, was_recording=one.was_recording)
        kept = samples if was_recorded else []
        one.was_recording = recording == "yes"
        if not kept and not changes:
            return
        try:
            with self._context.database.writing() as db:
                stored = self._write(db, one, kept, changes)
        except Exception:
            one.waiting.give_back(kept)
            one.was_recording = one.was_recording or was_recorded
            raise
        one.waiting.stored += stored
        for _ in changes:
            one.changes.popleft()
        self._context.background.recovered(THREAD)

    def _write(
        self, db: Session, one: Followed, samples: list[Sample], changes: list[Watched]
    ) -> int:
        session = session_by_id(db, one.session_id, lock=True)
        # Asked again under the lock: somebody may have refused, or been erased, since it was read.
        if recording_of(db, session) == "refused":
            return 0
        place = (one.link.door, one.link.source, one.link.reference or "")
        for change in changes:
            store_change(db, self._context, session, change, place=place)
        if not samples:
            return 0
        now, now_s = self._context.clock.utc_now(), self._now_s()
        return store_samples(db, session.id, samples, now=now, now_s=now_s)

    def _now_s(self) -> float:
        return self._context.clock.monotonic_ns() / 1e9


def is_from(sample: Sample, link: TrackerLink) -> bool:
    """Return whether a sample is of a link's source."""
    return (sample.door, sample.source) == (link.door, link.source)
