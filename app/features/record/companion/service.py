"""Keep the companions of all sessions: who is shown, to whose headset, and what waits for the disk.

Three threads meet here: a door's brings news of performers, the event loop serves the headset's
socket, and one of ours stores once a second what was shown.
"""

import logging
import threading
from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import cast

from sqlalchemy import select

from app.errors import NotFound
from app.features.movement.live import DoorKey
from app.features.movement.performers import PerformerName, Performers
from app.features.record.companion.frames import ShownFrame
from app.features.record.companion.recording import MAX_WAITING, ShownPose, store_frames
from app.features.record.headset import Waiting, is_kept, recording_of
from app.features.record.sessions import Companion, state_of
from app.models import StudySession
from app.platform.access import session_by_id
from app.platform.context import AppContext, Part

log = logging.getLogger(__name__)
THREAD = "companions"
EVERY_S = 1.0
_LATENCIES = 1024
Wake = Callable[[], None]


@dataclass(eq=False)
class Shown:
    """The companion of one session; None once nobody is shown any more.

    `wake` is that of the headset's socket, None while there is none. `is_seen`: the headset shows
    the companion now. `latencies_s`: the newest, from a packet's arrival to the headset's socket.
    """

    session_id: str
    companion: Companion | None = None
    wake: Wake | None = None
    is_seen: bool = False
    latencies_s: deque[float] = field(default_factory=lambda: deque(maxlen=_LATENCIES))
    waiting: Waiting[ShownPose] = field(default_factory=lambda: Waiting(MAX_WAITING))
    was_recording: bool = False

    def news(self) -> None:
        """Wake the socket for a frame of the performer, in a door's thread."""
        wake = self.wake
        if wake is not None and self.is_seen:
            wake()


class Companions(Part):
    """The companions of all sessions."""

    def __init__(self, context: AppContext) -> None:
        self._context = context
        self._shown: dict[str, Shown] = {}
        self._lock = threading.RLock()
        self._stopping = threading.Event()
        self._thread: threading.Thread | None = None

    def start(self) -> None:
        """Go on with the companions of sessions that had one when the server was stopped."""
        with self._context.database.reading() as db:
            rows = db.scalars(
                select(StudySession).where(StudySession.status.in_(("planned", "active")))
            )
            chosen = [row.id for row in rows if row.snapshot.get("companion") is not None]
        for session_id in chosen:
            self.follow(session_id)
        self._thread = self._context.background.thread(THREAD, self._run, critical=True)

    def stop(self) -> None:
        """Store what waits, and end."""
        self._stopping.set()
        if self._thread is not None:
            self._thread.join()

    def of(self, session_id: str) -> Shown | None:
        """Return the companion of a session; None if there never was one, nor a socket for it."""
        with self._lock:
            return self._shown.get(session_id)

    def follow(self, session_id: str) -> None:
        """Show the companion that is chosen for a session now, or nobody."""
        with self._context.database.reading() as db:
            chosen = state_of(session_by_id(db, session_id)).companion
        with self._lock:
            one = self._shown.get(session_id)
            if one is None:
                if chosen is None:
                    return
                one = self._shown[session_id] = Shown(session_id)
            self._show(one, chosen)

    def attach(self, session_id: str, wake: Wake) -> None:
        """Wake the socket of a session's headset on news; the newest socket replaces others."""
        with self._lock:
            one = self._shown.setdefault(session_id, Shown(session_id))
            before, one.wake, one.is_seen = one.wake, wake, False
        if before is not None:
            before()

    def is_attached(self, session_id: str, wake: Wake) -> bool:
        """Return whether this is still the newest socket of a session's headset."""
        one = self.of(session_id)
        return one is not None and one.wake is wake

    def detach(self, session_id: str, wake: Wake) -> None:
        """Wake this socket no more."""
        with self._lock:
            one = self._shown.get(session_id)
            if one is not None and one.wake is wake:
                one.wake, one.is_seen = None, False

    def sent(self, one: Shown, companion: Companion, frame: ShownFrame) -> None:
        """Keep a pose that was sent to the headset while it showed the companion."""
        one.waiting.add([(companion, frame)])
        one.latencies_s.append(frame.sent_s - frame.arrival_s)

    def _show(self, one: Shown, chosen: Companion | None) -> None:
        before = one.companion
        if before == chosen:
            return
        performers = self._context.part(Performers)
        if before is not None:
            performers.unwatch(name_of(before), one.news)
        one.companion = chosen
        one.latencies_s.clear()
        if chosen is not None:
            performers.watch(name_of(chosen), one.news)
        if one.wake is not None:
            one.wake()

    def _run(self) -> None:
        while not self._stopping.wait(EVERY_S):
            self._look_after_all()
        self._look_after_all()

    def _look_after_all(self) -> None:
        with self._lock:
            all_shown = tuple(self._shown.values())
        for one in all_shown:
            try:
                self.follow(one.session_id)
                self._store(one)
            except NotFound:
                # Its study was deleted as a whole, the demo lab's, so nobody misses what waits.
                self._forget(one)
            except Exception as error:
                # Reported here, so that it keeps no other session from being stored.
                log.exception("the companion of session %s could not be stored", one.session_id)
                self._context.background.failed(THREAD, error)
            else:
                if one.companion is None and one.wake is None:
                    self._forget(one)

    def _forget(self, one: Shown) -> None:
        with self._lock:
            if one.wake is None and self._shown.get(one.session_id) is one:
                self._show(one, None)
                del self._shown[one.session_id]

    def _store(self, one: Shown) -> None:
        """Store what waits in a transaction; if that fails, raise the error, and it waits on."""
        with self._context.database.reading() as db:
            recording = recording_of(db, session_by_id(db, one.session_id))
        frames = one.waiting.take()
        was_recorded = is_kept(recording, was_recording=one.was_recording)
        one.was_recording = recording == "yes"
        if not frames or not was_recorded:
            return
        now, now_s = self._context.clock.utc_now(), self._context.clock.monotonic_ns() / 1e9
        try:
            with self._context.database.writing() as db:
                session = session_by_id(db, one.session_id, lock=True)
                # Asked again under the lock: somebody may have refused since it was read.
                if recording_of(db, session) == "refused":
                    return
                stored = store_frames(db, session.id, frames, now=now, now_s=now_s)
        except Exception:
            one.waiting.give_back(frames)
            one.was_recording = True
            raise
        one.waiting.stored += stored
        self._context.background.recovered(THREAD)


def name_of(companion: Companion) -> PerformerName:
    """Return the performer whom a companion is."""
    # A door of this server's, which was checked when the companion was chosen.
    door = cast("DoorKey", companion.door)
    return PerformerName(door, companion.source, companion.skeleton)
