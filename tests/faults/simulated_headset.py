"""Run a headset through one phase of a simulated site, in simulated time.

What the network does to a correct headset is drawn from a seed: jitter, drift, an offline journal,
broken connections after which messages are resent, a client that restarts, a wall clock that is
set, pauses.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from datetime import timedelta
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.features.record.sessions import commands as c
from app.wire import BODY_STREAMS, StreamName, encode_batch
from tests.faults.simulated_site import Json, Site, Socket
from tests.wire.samples import standing

TICK_S, PER_TICK = 0.1, 2
DURATION_S, ROAM_S, FREEZE_S = 8.0, 4.0, 1.0
BOXES = 4
REFUSALS = ("refused", "closed", "error")
"""The types of the server's messages that reject something."""
TOUCH_S, BETWEEN_S = 0.08, 0.2


@dataclass(frozen=True)
class Frames:
    """A batch of frames before it is encoded; `times_s` and `flags` have the shape (n,)."""

    stream: StreamName
    epoch: int
    phase_id: int
    seq_first: int
    times_s: NDArray[np.float64]
    flags: NDArray[np.uint8]
    active_s: float

    def packed(self) -> bytes:
        """Return the batch encoded as a headset sends it."""
        closed_s = float(np.nan_to_num(self.times_s[-1], nan=0.0, posinf=0.0, neginf=0.0))
        return encode_batch(
            self.stream,
            epoch=self.epoch,
            phase_id=self.phase_id,
            seq_first=self.seq_first,
            times_s=self.times_s,
            flags=self.flags,
            values=standing(len(self.times_s)),
            active_s=self.active_s,
            closed_at_s=min(max(closed_s, 0.0), 1e9),
        )


Message = Json | Frames
Edit = Callable[[Message], list[Message]]


@dataclass
class Weather:
    """The network faults and pauses that a correct headset meets, drawn from a seed."""

    drift: float = 0.0
    jitter_s: float = 0.0
    offline: tuple[float, float] | None = None
    pause: tuple[float, float] | None = None
    broken_at_s: float | None = None
    new_client_at_s: float | None = None
    wall_step_s: float = 0.0
    time_scale: float = 1.0

    @classmethod
    def drawn(cls, rng: np.random.Generator) -> "Weather":
        """Draw a combination of faults, at most one of which stops the clock."""
        weather = cls(
            drift=float(rng.uniform(-1e-4, 1e-4)),
            jitter_s=float(rng.uniform(0.0, 0.03)),
            time_scale=float(rng.choice([1.0, 1.0, 1.0, 20.0])),
        )
        if rng.random() < 0.3:
            weather.wall_step_s = float(rng.choice([-3600.0, -5.0, 5.0, 3600.0]))
        at_s = float(rng.uniform(1.0, 6.0))
        match int(rng.integers(6)):
            case 0:
                weather.offline = (at_s, float(rng.choice([5.0, 60.0, 600.0])))
            case 1:
                weather.pause = (at_s, float(rng.uniform(1.0, 90.0)))
            case 2:
                weather.broken_at_s = at_s
            case 3:
                weather.new_client_at_s = at_s
            case _:
                pass
        return weather


@dataclass
class SimulatedHeadset:
    """A headset in one phase: its clock, sequence numbers, journal and task.

    `edit` may change, drop or add messages before they are journaled: this is where a lie is
    inserted. `pace` is the number of real seconds per second of the headset's clock: the inverse of
    the time scale for a correct headset.
    """

    site: Site
    session_id: str
    phase_id: int
    limb: str | None
    rng: np.random.Generator
    weather: Weather
    edit: Edit = lambda message: [message]
    hello_epoch: int | None = None
    pace: float = 1.0
    duration_s: float = DURATION_S
    socket: Socket = field(default_factory=lambda: Socket(iter(())))
    epoch: int = 0
    t_s: float = 20.0
    active_s: float = 0.0
    runs: bool = False
    seq: int = 0
    reports: int = 0
    completions: int = 0
    journal: list[Json | bytes] = field(default_factory=list)
    sent: list[Json | bytes] = field(default_factory=list)
    _touched: int = 0
    _completed_active_s: float = 0.0
    _next_touch_s: float = 0.3
    _probed: int = 0

    def play(self) -> None:
        """Run the whole phase, over as many connections as needed."""
        self.site.connect(self.session_id, self._first(), self.socket)
        weather = self.weather
        if weather.broken_at_s is not None and not self.refused:
            self.site.world.advance(float(self.rng.uniform(0.2, 600.0)))
            self.site.connect(self.session_id, self._again(), self.socket)
        if weather.new_client_at_s is not None and not self.refused:
            self.site.world.advance(float(self.rng.uniform(2.0, 60.0)))
            self.site.connect(self.session_id, self._anew(), self.socket)

    @property
    def refused(self) -> bool:
        """Return whether the server rejected a message or closed the connection."""
        return any(one["type"] in REFUSALS for one in self.socket.heard)

    def _first(self) -> Iterator[Json | bytes]:
        yield self._hello(self.hello_epoch)
        self.epoch = self._heard("welcome")["epoch"]
        self.site.command(self.session_id, c.BeginPhase(headset_connected=True))
        self._pass(1.2)
        self._report("started")
        self.runs = True
        yield from self._run()

    def _again(self) -> Iterator[Json | bytes]:
        """Reconnect the same client: it resends the last messages, then sends the rest."""
        yield self._hello(self.epoch)
        yield from self.sent[-int(self.rng.integers(1, 12)) :]
        self._pass(0.5)
        yield from self._delivered()
        self.site.command(self.session_id, c.Resume(headset_connected=True))
        yield from self._resume()
        yield from self._run()

    def _anew(self) -> Iterator[Json | bytes]:
        """Connect a new client: the memory and the clock of the first one are lost."""
        yield self._hello(None)
        welcome = [one for one in self.socket.heard if one["type"] == "welcome"][-1]
        order = welcome["state"]["phase"]
        self.epoch, self.seq, self.reports, self.t_s = welcome["epoch"], 0, 0, 3.0
        self.journal, self.sent = [], []
        self.active_s, self.completions = order["active_s"], order["completions"]
        self._touched, self._completed_active_s = 0, self.active_s
        self._next_touch_s = self.active_s + 0.3
        self._pass(0.4)
        self.site.command(self.session_id, c.Resume(headset_connected=True))
        yield from self._resume()
        yield from self._run()

    def _resume(self) -> Iterator[Json | bytes]:
        self._pass(0.3)
        self._report("resumed")
        self.runs = True
        yield from self._delivered()

    def _run(self) -> Iterator[Json | bytes]:
        """Run tick by tick until the time is up and the freeze is over."""
        weather, offline_until_s = self.weather, None
        while self.active_s < self.duration_s - 1e-9:
            self._tick(min(TICK_S, self.duration_s - self.active_s))
            at_s = self.active_s
            if weather.offline is not None and at_s >= weather.offline[0]:
                offline_until_s = self.site.world.monotonic_s + weather.offline[1]
                weather = replace(weather, offline=None)
            if offline_until_s is None or self.site.world.monotonic_s >= offline_until_s:
                offline_until_s = None
                yield from self._delivered()
                yield from self._probe()
            if weather.wall_step_s and at_s > self.duration_s / 3:
                self.site.world.wall += timedelta(seconds=weather.wall_step_s)
                weather = replace(weather, wall_step_s=0.0)
            if weather.pause is not None and at_s >= weather.pause[0]:
                yield from self._paused(weather.pause[1])
                weather = replace(weather, pause=None)
            first = self.epoch == 1 and self.sent
            if first and weather.broken_at_s is not None and at_s >= weather.broken_at_s:
                self.weather.broken_at_s = 99.0
                self.runs = False
                self._report("paused", cause="disconnected")
                return
            if first and weather.new_client_at_s is not None and at_s >= weather.new_client_at_s:
                return
        self.runs = False
        self._report("time_up")
        self._tick(FREEZE_S)
        self._report("ended")
        if offline_until_s is not None:
            self.site.world.advance(max(0.0, offline_until_s - self.site.world.monotonic_s))
        yield from self._delivered()
        counts = {"target": self.seq, "actual": self.seq, "reports": self.reports}
        yield from self._say({"type": "produced", "epoch": self.epoch, "streams": counts})

    def _paused(self, for_s: float) -> Iterator[Json | bytes]:
        """Let the operator pause the phase and resume it after a while."""
        yield from self._delivered()
        self.site.command(self.session_id, c.Pause())
        self._tick(TICK_S)
        self.runs = False
        self._report("paused", cause="operator")
        yield from self._delivered()
        for _ in range(5):
            self._tick(TICK_S)
        self._pass(for_s)
        yield from self._delivered()
        self.site.command(self.session_id, c.Resume(headset_connected=True))
        yield from self._resume()

    def _pass(self, seconds: float) -> None:
        """Advance the clocks of both ends without making frames."""
        self.t_s += seconds * (1.0 + self.weather.drift)
        self.site.world.advance(seconds * self.pace)

    def _tick(self, for_s: float) -> None:
        """Advance by one tick, with frames and, if the clock runs, the task."""
        begin_s, begin_active_s = self.t_s, self.active_s
        self.site.world.advance(for_s * self.pace / (1.0 + self.weather.drift))
        self.t_s += for_s
        if self.runs:
            self.active_s = min(self.active_s + for_s, self.duration_s)
        share = (np.arange(PER_TICK) + self.rng.uniform(0.05, 0.95, PER_TICK)) / PER_TICK
        self._draw(begin_s + share * for_s)
        if self.runs and self.limb is not None:
            self._touch(begin_s, begin_active_s)

    def _draw(self, times_s: NDArray[np.float64]) -> None:
        for stream in BODY_STREAMS:
            self._journal(
                Frames(
                    stream,
                    self.epoch,
                    self.phase_id,
                    self.seq,
                    times_s,
                    np.full(len(times_s), self.runs, np.uint8),
                    self.active_s,
                )
            )
        self.seq += len(times_s)

    def _touch(self, t_s: float, active_s: float) -> None:
        """Touch the next surface in the order for a moment, if a touch is due."""
        if active_s < self._next_touch_s or active_s + TOUCH_S > self.duration_s - 0.01:
            return
        self._next_touch_s = active_s + BETWEEN_S
        box = self._touched + 1 if self._touched < BOXES else None
        name, kind = ("target", "target") if box is None else (f"{box}/panel", "panel")
        if box is None:
            self.completions += 1
            self._told(
                kind="completion",
                number=self.completions,
                t_s=t_s,
                active_s=active_s,
                duration_s=active_s - self._completed_active_s,
                order=[int(one) for one in self.rng.permutation(BOXES) + 1],
                out_of_order_touches=0,
            )
            self._completed_active_s = active_s
        self._told(
            kind="contact",
            surface=f"{self.limb}/{name}",
            surface_kind=kind,
            box=box,
            side=None,
            body_part="RightHand",
            begin_s=t_s,
            end_s=t_s + TOUCH_S,
            begin_active_s=active_s,
            end_active_s=active_s + TOUCH_S,
            effect="completed" if box is None else "green",
        )
        self._touched = 0 if box is None else box

    def _report(self, what: str, cause: str = "headset") -> None:
        self._told(kind="phase", what=what, t_s=self.t_s, active_s=self.active_s, cause=cause)

    def _told(self, **body: Any) -> None:
        body = {"phase_id": self.phase_id, **body}
        self._journal({"type": "report", "epoch": self.epoch, "seq": self.reports, "body": body})

    def _journal(self, message: Message) -> None:
        for one in self.edit(message):
            if isinstance(one, Frames):
                self.journal.append(one.packed())
                continue
            if one.get("type") == "report":
                # A report added by a lie has a seq, too.
                one = {**one, "seq": one["seq"] if one.get("odd") else self.reports}
                self.reports += 1
            self.journal.append({key: value for key, value in one.items() if key != "odd"})

    def _delivered(self) -> Iterator[Json | bytes]:
        """Send all journaled messages after a short delay."""
        waiting, self.journal = self.journal, []
        if waiting and self.weather.jitter_s:
            self.site.world.advance(float(self.rng.uniform(0.0, self.weather.jitter_s)))
        for message in waiting:
            self.sent.append(message)
            yield message

    def _say(self, message: Json) -> Iterator[Json | bytes]:
        """Send messages that are not journaled: clock readings and counts."""
        for one in self.edit(message):
            assert not isinstance(one, Frames)
            yield one

    def _probe(self) -> Iterator[Json | bytes]:
        """Send clock readings about once a second."""
        self._probed += 1
        if self._probed % 10:
            return
        sent_s = self.t_s
        yield {"type": "probe", "client_sent_s": sent_s}
        answer = self._heard("probe")
        yield from self._say({**answer, "type": "probed", "client_received_s": sent_s + 0.004})

    def _hello(self, epoch: int | None) -> Json:
        return {"type": "hello", "protocol": 1, "client": "simulated", "epoch": epoch}

    def _heard(self, kind: str) -> Json:
        return [one for one in self.socket.heard if one["type"] == kind][-1]
