"""Keep every performer whose skeleton comes through a door, and record those who shall be."""

import threading
from collections.abc import Callable, Sequence

from app.errors import Busy, Conflict, NotFound
from app.features.movement.live import FORGOTTEN_S, SILENT_S, LiveTracking, Sample
from app.features.movement.performers.assembly import BodyFrame, skeletons_in
from app.features.movement.performers.performer import AgreedPose, Performer, PerformerName
from app.features.movement.performers.recording import (
    BYTES_PER_NUMBER,
    LONGEST_S,
    Recorded,
    Recording,
    is_same,
)
from app.models import new_id
from app.platform.context import AppContext, Part

MAX_PERFORMERS = 32
MAX_RECORDINGS = 4
USUAL_HZ = 120.0
"""The rate that is assumed of a performer before it is known."""
Wake = Callable[[], None]


class Performers(Part):
    """The performers of all doors, those who watch them, and the recordings."""

    def __init__(self, context: AppContext) -> None:
        self._context = context
        self._by_key: dict[tuple[PerformerName, str], Performer] = {}
        self._used: dict[PerformerName, str] = {}
        self._watchers: dict[PerformerName, tuple[Wake, ...]] = {}
        self._recordings: dict[str, Recording] = {}
        self._lock = threading.Lock()

    def start(self) -> None:
        """Follow what comes through the doors."""
        self._context.part(LiveTracking).add_follower(self._take)

    def stop(self) -> None:
        """Follow nothing more; recordings that were not stored are lost."""
        self._context.part(LiveTracking).remove_follower(self._take)

    def all(self) -> list[Performer]:
        """Return the performers in the order in which they appeared, without forgotten ones."""
        now_s = self.now_s()
        with self._lock:
            for key, one in list(self._by_key.items()):
                if now_s - one.last_s > FORGOTTEN_S:
                    del self._by_key[key]
            return list(self._by_key.values())

    def used(self, name: PerformerName) -> tuple[Performer | None, tuple[str, ...]]:
        """Return the performer that is used under a name, and other senders of that name.

        The first sender is used until it was silent for `SILENT_S` while another one sends.
        """
        with self._lock:
            return self._used_of(name, self.now_s())

    def rate_hz(self, performer: Performer) -> float | None:
        """Return a performer's frames per second of late; None if there are too few."""
        with self._lock:
            return performer.rate_hz(self.now_s())

    def agree(self, name: PerformerName, pose: AgreedPose) -> None:
        """Take the performer's present frame as an agreed pose; raises NotFound or Conflict."""
        with self._lock:
            performer = self._present(name)
            if not performer.agree(pose):
                raise Conflict(
                    "not every bone of this skeleton has been seen",
                    value=list(performer.missing),
                    remedy="Wait until all bones are sent, then try again.",
                )
            watchers = self._watchers.get(name, ())
        for wake in watchers:
            wake()

    def watch(self, name: PerformerName, wake: Wake) -> None:
        """Call `wake` in a door's thread at each frame: it must be quick, and must not raise."""
        with self._lock:
            self._watchers[name] = (*self._watchers.get(name, ()), wake)

    def unwatch(self, name: PerformerName, wake: Wake) -> None:
        """Call it no more."""
        with self._lock:
            left = tuple(one for one in self._watchers.get(name, ()) if one != wake)
            self._watchers[name] = left
            if not left:
                del self._watchers[name]

    def record(self, name: PerformerName, by: str) -> Recording:
        """Start to record a performer; raises NotFound, Conflict or Busy."""
        with self._lock:
            performer = self._present(name)
            agreed = performer.agreed
            if agreed is None:
                raise Conflict(
                    "not every bone of this skeleton has been seen",
                    value=list(performer.missing),
                    remedy="Wait until all bones are sent, then record.",
                )
            if any(one.name == name for one in self._recordings.values()):
                raise Conflict(
                    "this performer is being recorded, or a recording is not stored yet",
                    remedy="Store or discard that recording first.",
                )
            if len(self._recordings) >= MAX_RECORDINGS:
                raise Busy(
                    "too many recordings go on or are not stored yet",
                    value=len(self._recordings),
                    valid=f"up to {MAX_RECORDINGS} at once",
                    remedy="Store or discard one of them first.",
                )
            rate_hz = performer.rate_hz(self.now_s()) or USUAL_HZ
            row_bytes = BYTES_PER_NUMBER * (3 + 3 * agreed.rig.joint_count)
            max_frames = max(1, self._context.settings.max_capture_bytes // row_bytes)
            recording = Recording(
                id=new_id(),
                name=name,
                rig=agreed.rig,
                by=by,
                since=self._context.clock.utc_now(),
                limit_s=min(LONGEST_S, max_frames / rate_hz),
                max_frames=max_frames,
            )
            self._recordings[recording.id] = recording
            return recording

    def recordings(self) -> list[Recording]:
        """Return the recordings that are not stored yet, in the order in which they began."""
        with self._lock:
            return list(self._recordings.values())

    def recorded(self, recording_id: str) -> tuple[Recording, Recorded]:
        """End a recording and return what was recorded; it stays until it is discarded.

        Raises NotFound, or Conflict if there is no frame in it.
        """
        with self._lock:
            recording = self._recording(recording_id)
            if recording.frames == 0:
                raise Conflict(
                    "nothing was recorded: the source has sent nothing since",
                    remedy="Wait until it sends, or discard the recording.",
                )
            if recording.state == "running":
                recording.state = "ended"
            performer, _ = self._used_of(recording.name, self.now_s())
            agreed = None if performer is None else performer.agreed
            if agreed is not None and is_same(agreed.rig, recording.rig):
                recording.rig = agreed.rig  # with a T-pose that was shown meanwhile
        # An ended recording takes no more frames: the door's thread need not wait for this.
        return recording, recording.recorded()

    def discard(self, recording_id: str) -> None:
        """Forget a recording; raises NotFound."""
        with self._lock:
            del self._recordings[self._recording(recording_id).id]

    def now_s(self) -> float:
        """Return the time by the clock by which packets arrive."""
        return self._context.clock.monotonic_ns() / 1e9

    def _take(self, samples: Sequence[Sample]) -> None:
        for sample in samples:
            waking: set[PerformerName] = set()
            # Given back after each one, so that pages do not wait for a whole batch.
            with self._lock:
                self._take_one(sample, waking)
                watchers = [wake for name in waking for wake in self._watchers.get(name, ())]
            for wake in watchers:
                wake()

    def _take_one(self, sample: Sample, waking: set[PerformerName]) -> None:
        if sample.door == "headset" or sample.is_late:
            return
        for skeleton, definition in skeletons_in(sample):
            name = PerformerName(sample.door, sample.source, skeleton)
            performer = self._performer(name, sample)
            if performer is None:
                continue
            frames = performer.take(sample, definition)
            if frames and self._used_of(name, sample.arrival_s)[0] is performer:
                waking.add(name)
                self._keep(name, frames)

    def _keep(self, name: PerformerName, frames: list[BodyFrame]) -> None:
        for recording in self._recordings.values():
            if recording.name == name:
                for frame in frames:
                    recording.take(frame)

    def _performer(self, name: PerformerName, sample: Sample) -> Performer | None:
        """Return the performer of a sample; None if there are too many at once."""
        key = (name, sample.address)
        found = self._by_key.get(key)
        if found is None and self._has_room(sample.arrival_s):
            found = self._by_key[key] = Performer(name, sample.address)
        return found

    def _has_room(self, now_s: float) -> bool:
        if len(self._by_key) < MAX_PERFORMERS:
            return True
        key, oldest = min(self._by_key.items(), key=lambda item: item[1].last_s)
        if now_s - oldest.last_s <= SILENT_S:
            return False
        del self._by_key[key]
        return True

    def _used_of(
        self, name: PerformerName, now_s: float
    ) -> tuple[Performer | None, tuple[str, ...]]:
        found = {address: one for (own, address), one in self._by_key.items() if own == name}
        if not found:
            self._used.pop(name, None)
            return None, ()
        sending = [address for address, one in found.items() if now_s - one.last_s <= SILENT_S]
        used = self._used.get(name)
        if used not in found or (used not in sending and sending):
            newest = max(found, key=lambda address: found[address].last_s)
            used = self._used[name] = sending[0] if sending else newest
        return found[used], tuple(one for one in sending if one != used)

    def _present(self, name: PerformerName) -> Performer:
        performer, _ = self._used_of(name, self.now_s())
        if performer is None:
            raise NotFound(
                "there is no such performer",
                value=f"{name.source} {name.skeleton}".strip(),
                remedy="Choose one that is shown on the page Trackers.",
            )
        return performer

    def _recording(self, recording_id: str) -> Recording:
        found = self._recordings.get(recording_id)
        if found is None:
            raise NotFound(
                "there is no such recording",
                value=recording_id,
                remedy="It was stored, discarded, or lost when the server ended: see the captures.",
            )
        return found
