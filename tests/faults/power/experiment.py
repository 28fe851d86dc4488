"""Stream from headsets to a traced server, then emulate power losses throughout the trace."""

import asyncio
import math
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from tests.faults.power.disk import MOODS, Disk, replay, timeline
from tests.faults.power.files import Rng
from tests.faults.power.image import Verdict, judge, positions_in, promised_by, write_image
from tests.faults.power.promises import Position, Promise, promises_of
from tests.faults.streaming import pair_headsets, stream
from tests.faults.tracing.events import Event, read_events
from tests.faults.tracing.running import RECORD, traced_server
from tests.rehearsal.ledger import LedgerJournal
from tests.support.server import REEMBODY

Flush = tuple[int, int, Mapping[Position, int]]
"""Stamp and time of a sync's return, and the positions that are on disk by then."""


@dataclass(frozen=True)
class Recording:
    """A recorded run of a server: its calls, its promises, and its headsets' journals."""

    folder: Path
    events: Sequence[Event]
    promises: Sequence[Promise]
    ledgers: Mapping[str, LedgerJournal]
    flushes: list[Flush] = field(default_factory=list)
    """The certain data of each flush, filled in by `prove_acks`; variants of a run share it."""

    @property
    def data_dir(self) -> str:
        """Return the folder of the database."""
        return str((self.folder / "data").resolve())

    def with_earlier_acks(self) -> "Recording":
        """Return the run as if the server had sent each acknowledgement before the flush.

        Each promise counts from the moment when the last sync before it began.
        """
        began = np.array([e.began for e in self.events if e.what == "sync"])
        earlier = []
        for promise in self.promises:
            at = int(np.searchsorted(began, promise.began)) - 1
            earlier.append(replace(promise, began=int(began[at])) if promise.is_ack else promise)
        return replace(self, promises=earlier)


def record_streaming(
    folder: Path,
    headsets: int,
    most_s: float,
    command: Sequence[str] = REEMBODY,
    *,
    most_acks: float = math.inf,
) -> Recording:
    """Stream in real time, stop the server and return the recording.

    The headsets stop after `most_s` seconds, or when they have heard `most_acks` acknowledgements.
    """
    folder.mkdir()
    with traced_server(folder, command) as server:
        paired = pair_headsets(server, headsets)
        end_s = time.monotonic() + most_s

        def more() -> bool:
            heard = sum(headset.ledger.acknowledgements for headset in paired)
            return time.monotonic() < end_s and heard < most_acks

        asyncio.run(stream(server, paired, more))
    events = read_events(folder / RECORD)
    ledgers = {headset.session_id: headset.ledger for headset in paired}
    return Recording(folder, events, promises_of(events), ledgers)


@dataclass(frozen=True)
class AckProof:
    """The acknowledgements of a recording, compared with the flushes that made their data durable.

    `early`: acknowledgements sent before a completed flush contained the promised data. `waits_ms`:
    for each of the others, the time from that flush's return to the send.
    """

    acks: int
    syncs: int
    early: int
    waits_ms: tuple[float, ...]


def prove_acks(recording: Recording) -> AckProof:
    """After each flush, open the data that are certain and compare them with the acknowledgements.

    SQLite's own recovery thus decides whether the bytes on disk contain a position.
    """
    flushed = recording.flushes
    if not flushed:
        flushed += _flushes_of(recording)
    acks = [promise for promise in recording.promises if promise.is_ack]
    waits_ms, early = [], 0
    for ack in acks:
        holding = next((one for one in flushed if _holds(one[2], ack.positions)), None)
        if holding is None or holding[0] > ack.began:
            early += 1
        else:
            waits_ms.append((ack.began_ns - holding[1]) / 1e6)
    return AckProof(len(acks), len(flushed), early, tuple(waits_ms))


def _flushes_of(recording: Recording) -> Iterator[Flush]:
    disk = Disk(recording.data_dir)
    for stamp, returned, event in timeline(recording.events):
        replay(disk, [(stamp, returned, event)])
        if returned and event.what == "sync":
            database = write_image(recording.folder / "image", disk.certain())
            yield stamp, event.ended_ns, positions_in(database)


def _holds(stored: Mapping[Position, int], promised: Mapping[Position, int]) -> bool:
    return all(stored.get(key, 0) >= seq for key, seq in promised.items())


@dataclass(frozen=True)
class CrashPoint:
    """A power loss just after the call with this stamp has begun or returned."""

    stamp: int
    where: str
    mood: str


@dataclass(frozen=True)
class Crash:
    """A crash point, and the verdict on the disk image it left."""

    point: CrashPoint
    promised: int
    verdict: Verdict


def draw_crash_points(recording: Recording, count: int, rng: Rng) -> list[CrashPoint]:
    """Draw moments around every kind of call, in order of time, with every mood of the disk."""
    places = _places(recording)
    kinds = sorted(places)
    drawn = []
    for number in range(count):
        where = kinds[number % len(kinds)]
        mood = MOODS[number // len(kinds) % len(MOODS)]
        drawn.append(CrashPoint(int(rng.choice(places[where])), where, mood))
    return sorted(drawn, key=lambda point: point.stamp)


def _places(recording: Recording) -> dict[str, list[int]]:
    syncs = [event for event in recording.events if event.what == "sync"]
    of_database = [
        event.began
        for event in recording.events
        if event.what in ("write", "truncate") and event.path.endswith(".sqlite")
    ]
    first_promise = min(promise.began for promise in recording.promises)
    return {
        "while starting": [e.began for e in recording.events if e.began < first_promise],
        "before a flush": [event.began - 1 for event in syncs],
        "in a flush": [event.began for event in syncs],
        "after a flush": [event.ended for event in syncs],
        "after an ack": [promise.began for promise in recording.promises],
        "in a checkpoint": of_database,
        "anywhere": [event.began for event in recording.events],
    }


def crash_at(recording: Recording, points: Iterable[CrashPoint], rng: Rng) -> list[Crash]:
    """Emulate a power loss at each point (in order) and open the image it left."""
    disk, moments = Disk(recording.data_dir), timeline(recording.events)
    crashes, at = [], 0
    for point in points:
        while at < len(moments) and moments[at][0] <= point.stamp:
            replay(disk, moments[at : at + 1])
            at += 1
        image = disk.after_power_loss(rng, point.mood)
        promised = promised_by(recording.promises, point.stamp)
        database = write_image(recording.folder / "image", image)
        verdict = judge(database, promised, recording.ledgers)
        crashes.append(Crash(point, sum(promised.positions.values()), verdict))
    return crashes
