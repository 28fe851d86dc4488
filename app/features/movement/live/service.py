"""Open and close the doors, keep the sources' state, and show both."""

import logging
import threading
from collections import Counter
from collections.abc import Callable, Sequence
from datetime import datetime

from sqlalchemy import select
from sqlalchemy.orm import Session

from app.adapters.live import Reading
from app.errors import InvalidInput
from app.features.movement.live.doors import USUAL_PORTS, DoorSettings, interfaces, stored_doors
from app.features.movement.live.listening import DoorState, Listener, Received
from app.features.movement.live.schemas import (
    DoorView,
    LimbWish,
    LiveView,
    SourceView,
    TrackerView,
)
from app.features.movement.live.sources import (
    SILENT_S,
    DoorKey,
    Sample,
    Source,
    Sources,
    Tracker,
)
from app.models import LiveLimb
from app.platform.context import AppContext, Part
from app.science.skeleton import JOINT_NAMES

log = logging.getLogger(__name__)
Limbs = dict[tuple[str, str, str], str]
Follower = Callable[[Sequence[Sample]], None]
"""Takes samples in a door's thread as they come in: it must be quick, and must not raise."""
MS_PER_S = 1000.0


class LiveTracking(Part):
    """The listeners of the open doors, and the sources behind all of them."""

    def __init__(self, context: AppContext) -> None:
        self._context = context
        self._listeners: dict[DoorKey, Listener] = {}
        self._resumed: set[DoorKey] = set()
        self._sources = Sources()
        self._followers: tuple[Follower, ...] = ()
        self._lock = threading.Lock()
        self._switching = threading.Lock()

    def start(self) -> None:
        """Open the doors that were open when the server was stopped, and say so."""
        for key in USUAL_PORTS:
            self.follow(key)
        self._resumed = set(self._listeners)
        for key, listener in self._listeners.items():
            own, state = listener.settings, listener.state
            log.info("door %s, opened by %s, is %s again on %s", key, own.by, state, own.interface)

    def stop(self) -> None:
        """Close all doors."""
        with self._switching:
            for listener in self._listeners.values():
                listener.stop()
            self._listeners.clear()

    def state_of(self, door: str) -> DoorState | None:
        """Return the state of a door, `failed` while it tries in vain; None if it is closed."""
        listener = next((one for key, one in self._listeners.items() if key == door), None)
        return None if listener is None else listener.state

    def follow(self, door: DoorKey) -> None:
        """Open or close a door, or open it anew, as its stored settings say.

        They are read here, one switch at a time, so that of two people who switch at once the one
        whose wish was stored last also has the door.
        """
        with self._switching:
            with self._context.database.reading() as db:
                settings = next(one for one in stored_doors(db) if one.door == door)
            listener = self._listeners.get(door)
            if listener is not None and listener.settings != settings:
                del self._listeners[door]
                self._resumed.discard(door)
                listener.stop()
                listener = None
                with self._lock:
                    self._sources.forget(door)
            if settings.is_open and listener is None:
                listener = Listener(settings, self._take, self._context.clock.monotonic_ns)
                listener.start()
                self._listeners[door] = listener

    def add_follower(self, follower: Follower) -> None:
        """Give every sample from now on to `follower`, too; doubled and late ones are none."""
        with self._lock:
            self._followers = (*self._followers, follower)

    def remove_follower(self, follower: Follower) -> None:
        """Give a follower nothing more."""
        with self._lock:
            self._followers = tuple(one for one in self._followers if one != follower)

    def view(self, db: Session) -> LiveView:
        """Return all doors and sources as they are now."""
        limbs: Limbs = {
            (row.door, row.source, row.tracker): row.limb for row in db.scalars(select(LiveLimb))
        }
        now_s = self._context.clock.monotonic_ns() / 1e9
        with self._lock:
            sources = list(self._sources.all(now_s))
            names = Counter(
                (one.key.door, one.key.name)
                for one in sources
                if one.key.name and now_s - one.last_s <= SILENT_S
            )
            shown = [
                _source(one, now_s, limbs, same_name=names[one.key.door, one.key.name] > 1)
                for one in sources
            ]
        return LiveView(
            interfaces=list(interfaces()),
            limbs=list(JOINT_NAMES),
            doors=[
                _door(one, self._listeners.get(one.door), resumed=one.door in self._resumed)
                for one in stored_doors(db)
            ],
            sources=shown,
            turned_away=self._sources.turned_away.total(),
        )

    def _take(self, door: DoorKey, batch: list[tuple[str, Reading, float]]) -> None:
        with self._lock:
            noted = [
                self._sources.note(door, address, reading, arrival_s)
                for address, reading, arrival_s in batch
            ]
            followers = self._followers
        samples = [one for one in noted if one is not None]
        if not samples:
            return
        for follower in followers:
            follower(samples)


def limbs_of(db: Session, door: str, source: str) -> dict[str, str]:
    """Return on which limbs the trackers of a source are worn, by tracker."""
    rows = select(LiveLimb).where(LiveLimb.door == door, LiveLimb.source == source)
    return {row.tracker: row.limb for row in db.scalars(rows)}


def store_limb(db: Session, wish: LimbWish, *, by: str, now: datetime) -> None:
    """Store on which limb a tracker is worn; raises InvalidInput if there is no such limb."""
    if wish.limb is not None and wish.limb not in JOINT_NAMES:
        raise InvalidInput(
            "there is no such limb",
            value=wish.limb,
            valid=list(JOINT_NAMES),
            remedy="Choose one of the body's joints, or none.",
        )
    row = db.get(LiveLimb, (wish.door, wish.source, wish.tracker))
    if wish.limb is None:
        if row is not None:
            db.delete(row)
    else:
        row = row or LiveLimb(door=wish.door, source=wish.source, tracker=wish.tracker)
        row.limb, row.by, row.at = wish.limb, by, now
        db.add(row)
    db.flush()


def _door(settings: DoorSettings, listener: Listener | None, *, resumed: bool) -> DoorView:
    received = listener.received if listener is not None else Received()
    trouble = None if listener is None else listener.trouble
    return DoorView(
        door=settings.door,
        is_open=settings.is_open,
        interface=settings.interface,
        port=settings.port,
        server=settings.server,
        multicast=settings.multicast,
        state=None if listener is None else listener.state,
        trouble=None if trouble is None else trouble.kind,
        trouble_detail="" if trouble is None else trouble.detail,
        opened_by=settings.by if settings.is_open else None,
        opened_at=settings.at if settings.is_open else None,
        resumed=resumed,
        packets=received.packets,
        foreign=received.foreign,
        unread=received.unread,
        dropped=received.dropped,
    )


def _source(source: Source, now_s: float, limbs: Limbs, *, same_name: bool) -> SourceView:
    uncertainty_s = source.clock.uncertainty_s
    return SourceView(
        door=source.key.door,
        address=source.key.address,
        name=source.label,
        silent_s=now_s - source.last_s,
        is_silent=now_s - source.last_s > SILENT_S,
        same_name=same_name,
        packets=source.packets,
        doubled=source.doubled if source.ordered else None,
        late=source.late if source.ordered else None,
        skipped=source.skipped if source.ordered else None,
        restarts=source.restarts,
        offset_s=source.clock.offset_s,
        uncertainty_ms=None if uncertainty_s is None else uncertainty_s * MS_PER_S,
        problems={str(kind): count for kind, count in sorted(source.problems.items())},
        trackers=[
            _tracker(name, one, now_s, limbs.get((source.key.door, source.label, name)))
            for name, one in source.trackers.items()
        ],
    )


def _tracker(name: str, tracker: Tracker, now_s: float, limb: str | None) -> TrackerView:
    pose, jitter_s = tracker.pose, tracker.jitter_s
    return TrackerView(
        name=name,
        kind="tracker" if pose is None else pose.kind,
        tracked=pose is not None and pose.tracked,
        samples=tracker.samples,
        rate_hz=tracker.rate_hz(now_s),
        gaps=tracker.gaps,
        longest_gap_ms=tracker.longest_gap_s * MS_PER_S,
        jitter_ms=None if jitter_s is None else jitter_s * MS_PER_S,
        silent_s=now_s - tracker.last_s,
        position_m=None if pose is None else pose.position_m,
        limb=limb,
    )
