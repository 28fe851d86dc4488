"""A headset that streams a moving body in real time, pauses and continues."""

import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass

import numpy as np

from app.wire import BODY_STREAMS
from tests.features.record.headset.site import Headset, Site
from tests.science.stream_quality.recordings import generated
from tests.support.beside import beside
from tests.wire.samples import RATE_HZ, message

PER_BATCH = 9
SOUND = generated(1)


@dataclass
class Streamer:
    """Send both streams of a body; `t_s` is the headset's clock, `active_s` the phase's."""

    headset: Headset
    phase_id: int = 0
    seq: int = 0
    t_s: float = 5.0
    active_s: float = 0.0
    last_sent_s: float = 0.0

    def stream(self, for_s: float, *, running: bool = True, at_once: bool = False) -> None:
        """Send the frames of `for_s` seconds, in real time unless `at_once` is set."""
        began_s, frames = time.monotonic(), round(for_s * RATE_HZ)
        for done in range(0, frames, PER_BATCH):
            self.send_batch(running=running)
            if not at_once:
                due_s = began_s + (done + PER_BATCH) / RATE_HZ
                time.sleep(max(0.0, due_s - time.monotonic()))

    def send_batch(self, *, running: bool = True) -> None:
        """Send one batch of each stream."""
        picked = (self.seq + np.arange(PER_BATCH)) % len(SOUND)
        values = np.concatenate(
            (SOUND.positions_m[picked], SOUND.rotations[picked].reshape(PER_BATCH, -1)), axis=1
        )
        times_s = self.t_s + np.arange(PER_BATCH) / RATE_HZ
        self.t_s += PER_BATCH / RATE_HZ
        self.active_s += PER_BATCH / RATE_HZ if running else 0.0
        for stream in BODY_STREAMS:
            self.headset.say(
                message(
                    values,
                    stream=stream,
                    epoch=self.headset.epoch,
                    phase_id=self.phase_id,
                    seq_first=self.seq,
                    times_s=times_s,
                    active=running,
                    active_s=self.active_s,
                )
            )
        self.seq += PER_BATCH
        self.last_sent_s = time.monotonic()

    @contextmanager
    def streaming(self, *, running: bool = False, probing: bool = False) -> Iterator[None]:
        """Stream in a thread during the block, which may receive messages but not send them.

        With `probing` it also exchanges clock probes; then the block may not receive messages
        either.
        """

        def go_on(over: threading.Event) -> None:
            while not over.wait(PER_BATCH / RATE_HZ):
                self.send_batch(running=running)
                if probing:
                    self.probe()

        with beside(go_on):
            yield

    def probe(self) -> None:
        """Exchange one clock probe, as a headset does once a second."""
        self.headset.say({"type": "probe", "client_sent_s": self.t_s})
        answer = self.headset.hear("probe")
        self.headset.say({**answer, "type": "probed", "client_received_s": self.t_s + 0.004})


def materialised(site: Site, **fields: str) -> str:
    """Return a session whose current step is entering the body."""
    session_id = site.join(**fields)
    site.skip_to(session_id, "materialise")
    return session_id


def in_free_movement(site: Site, session_id: str, headset: Headset) -> Streamer:
    """Enter the body and start the clock of the free movement; return its streamer."""
    headset.reported(kind="materialised", t_s=1.0)
    site.command(session_id, "begin_phase")
    state = headset.hear("state", lambda state: state["phase"] is not None)
    phase_id = int(state["phase"]["phase_id"])
    headset.reported(kind="phase", phase_id=phase_id, what="started", t_s=5.0, active_s=0.0)
    return Streamer(headset, phase_id)
