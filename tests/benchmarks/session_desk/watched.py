"""Run a session that streams at real speed while four consoles watch it.

The headset is the load's own (90 frames a second of both streams, six per message, a contact per
second). One console is a page in a real browser that draws the body in 3-D; three more only
receive: each follows the session's live stream, and its poses as fast as they arrive.
"""

import asyncio
import threading
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, Page, ViewportSize
from websockets.asyncio.client import connect

from tests.benchmarks.load.consoles import ConsolePlan
from tests.benchmarks.load.lab import Lab, call_phases, make_lab
from tests.benchmarks.load.lean import LeanHeadset
from tests.benchmarks.load.movement import make_movement
from tests.benchmarks.load.processes import Companion
from tests.benchmarks.load.record import Record
from tests.benchmarks.load.streaming import Streaming
from tests.support.server import LiveServer

SUBSCRIBERS = 3
SIZE = ViewportSize(width=1280, height=800)
STARTS_WITHIN_S = 60.0
DRAWS_WITHIN_MS = 60_000


@dataclass
class Sender:
    """The headset and the pose subscribers, on a thread; `record` contains the send times."""

    server: LiveServer
    lab: Lab
    duration_s: float
    record: Record = field(init=False)
    error: BaseException | None = None
    _connected: threading.Event = field(default_factory=threading.Event)
    _entered: threading.Event = field(default_factory=threading.Event)
    _begin: threading.Event = field(default_factory=threading.Event)
    _thread: threading.Thread | None = None

    def start(self) -> None:
        """Connect, let the operator begin the phase, and wait until it runs."""
        self.record = Record(self.lab.seats[0].session_id)
        self._thread = threading.Thread(target=self._live, daemon=True)
        self._thread.start()
        self._wait_for(self._connected)
        call_phases(self.server, self.lab)
        self._wait_for(self._entered)

    def begin(self) -> None:
        """Send the first frame."""
        self._begin.set()

    def join(self) -> None:
        """Wait for the last frame; raise any error of the thread."""
        assert self._thread is not None
        self._thread.join(self.duration_s + STARTS_WITHIN_S)
        self._raise()

    def _wait_for(self, event: threading.Event) -> None:
        came = event.wait(STARTS_WITHIN_S)
        self._raise()
        if not came:
            raise TimeoutError("the headset did not get ready")

    def _raise(self) -> None:
        failure = self.error or self.record.failure
        if failure is not None:
            raise RuntimeError(f"the headset failed: {failure}")

    def _live(self) -> None:
        try:
            asyncio.run(self._stream())
        except BaseException as error:  # noqa: BLE001 - told by whoever waits
            self.error = error
            for event in (self._connected, self._entered):
                event.set()

    async def _stream(self) -> None:
        url = self.server.url.replace("http", "ws", 1)
        seat = self.lab.seats[0]
        headset = await LeanHeadset.open(f"{url}/api/vr/stream", seat.token, self.record)
        others = [
            asyncio.create_task(self._look_on(f"{url}/api/sessions/{seat.session_id}/pose"))
            for _ in range(SUBSCRIBERS)
        ]
        movement = make_movement(np.random.default_rng(3))
        stream = Streaming(headset, self.record, movement, 0, contact_every_s=1.0, digested=False)
        self._connected.set()
        await stream.enter_phase()
        self._entered.set()
        await asyncio.to_thread(self._begin.wait)
        begin_s = time.monotonic()
        await stream.run(begin_s, begin_s + self.duration_s)
        for other in others:
            other.cancel()
        await asyncio.gather(*others, return_exceptions=True)
        await headset.close()

    async def _look_on(self, url: str) -> None:
        """Receive every pose and immediately acknowledge it as drawn."""
        cookie = "; ".join(f"{name}={value}" for name, value in self.lab.cookies.items())
        headers = {"cookie": cookie, "origin": self.server.url}
        async with connect(url, additional_headers=headers, compression=None) as socket:
            async for message in socket:
                if isinstance(message, bytes):
                    await socket.send("")


@dataclass(frozen=True)
class Watched:
    """A running session whose page already draws, and whose first frame was sent."""

    server: LiveServer
    page: Page
    sender: Sender


@contextmanager
def watched_session(
    folder: Path, browser: Browser, duration_s: float, script: str = ""
) -> Iterator[Watched]:
    """Run a streaming session that four consoles watch.

    `script` runs in the page before the page's own scripts.
    """
    with ExitStack() as stack:
        server = stack.enter_context(LiveServer(folder))
        lab = make_lab(server, 1)
        sender = Sender(server, lab, duration_s)
        sender.start()
        page = _open_cockpit(stack, browser, server, lab, script)
        sessions = tuple((number, lab.seats[0].session_id) for number in range(SUBSCRIBERS))
        plan = ConsolePlan(
            server.url,
            lab.cookies,
            sessions,
            duration_s,
            str(folder / "news.npy"),
            str(folder / "views.npy"),
        )
        consoles = stack.enter_context(Companion.start("load.consoles", plan, folder / "consoles"))
        consoles.wait_for("connected")
        consoles.wait_for("ready")
        consoles.begin(time.monotonic())
        sender.begin()
        moving = "() => document.querySelector('[data-way=space][data-moving=true]') !== null"
        page.wait_for_function(moving, timeout=DRAWS_WITHIN_MS)
        yield Watched(server, page, sender)


def _open_cockpit(
    stack: ExitStack, browser: Browser, server: LiveServer, lab: Lab, script: str
) -> Page:
    context = browser.new_context(viewport=SIZE, locale="en-US")
    stack.callback(context.close)
    if script:
        context.add_init_script(script)
    for name, value in lab.cookies.items():
        context.add_cookies([{"name": name, "value": value, "url": server.url}])
    page = context.new_page()
    page.goto(f"{server.url}/#/sessions/{lab.seats[0].session_id}")
    page.wait_for_function(
        "() => document.querySelector('[data-way=space]') !== null", timeout=DRAWS_WITHIN_MS
    )
    return page
