"""Measure what a browser without a cache fetches for the first page, and how long it takes.

Bytes are those on the wire (compressed, with headers), as the browser counts them. A page is ready
when its essential content is drawn; the time starts at the navigation.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from http.cookies import SimpleCookie
from pathlib import Path
from typing import Any

import httpx2
import numpy as np
from playwright.sync_api import Browser, Page, ViewportSize
from playwright.sync_api import TimeoutError as NotInTime

from tests.benchmarks.report import Figure
from tests.benchmarks.session_desk.site import FORMS, Desk, signed_in
from tests.support.browser import launched_browser
from tests.support.server import LiveServer

PART = "load"
REPEATS = 5
KB = 1000.0
LIMIT_KB, LIMIT_MS = 500.0, 1500.0
QUIET_MS = 1500
SIZE = ViewportSize(width=1280, height=800)
READY_WITHIN_MS = 30_000
WHEN_DRAWN = """
window.drawnAt = null;
const look = () => {
  const one = document.querySelector(SELECTOR);
  if (one !== null && one.getClientRects().length > 0) window.drawnAt = performance.now();
  else requestAnimationFrame(look);
};
requestAnimationFrame(look);
"""


@dataclass(frozen=True)
class FirstPage:
    """A page with the content that must be drawn on it; `cookies` is the Cookie header."""

    name: str
    path: str
    selector: str
    cookies: str = ""


@dataclass
class Wire:
    """The bytes and files that a browser received."""

    total: int = 0
    by_file: dict[str, int] = field(default_factory=dict)
    _names: dict[str, str] = field(default_factory=dict)

    def attach(self, page: Page) -> None:
        """Count what a page fetches."""
        session = page.context.new_cdp_session(page)
        session.on("Network.responseReceived", self._named)
        session.on("Network.loadingFinished", self._came)
        session.send("Network.enable")

    def _named(self, event: dict[str, Any]) -> None:
        self._names[event["requestId"]] = event["response"]["url"].rpartition("/")[2]

    def _came(self, event: dict[str, Any]) -> None:
        size = int(event["encodedDataLength"])
        self.total += size
        name = self._names.get(event["requestId"], "?")
        self.by_file[name] = self.by_file.get(name, 0) + size


def figures(folder: Path) -> Iterator[Figure]:
    """Measure the console and the tablet, before and after signing in or pairing."""
    with LiveServer(folder) as server, signed_in(server) as desk, launched_browser() as browser:
        for page in _pages(desk):
            found = [_load(browser, server.url, page) for _ in range(REPEATS)]
            size_kb = max(wire.total for _, wire in found) / KB
            drawn_ms = float(np.median([drawn_ms for drawn_ms, _ in found]))
            yield Figure(PART, f"{page.name}: fetched", size_kb, "kB", "limit", LIMIT_KB)
            yield Figure(
                PART, f"{page.name}: drawn, p50 of {REPEATS}", drawn_ms, "ms", "limit", LIMIT_MS
            )


def _pages(desk: Desk) -> Iterator[FirstPage]:
    desk.add_forms_study(1)
    session = desk.post(f"/api/studies/{FORMS}/sessions", {"kind": "test"})
    operator = _header(desk.client)
    yield FirstPage("console, login", "/", "input[type=password]")
    yield FirstPage("console, studies", "/", "main h1, main h2", operator)
    cockpit = f"/#/sessions/{session['id']}"
    yield FirstPage("console, cockpit", cockpit, "main section h2", operator)
    yield FirstPage("tablet, not paired", "/tablet/", "input")
    form = "[data-name] input[type=radio]"
    yield FirstPage("tablet, form", "/tablet/", form, desk.tablet_at_form())


def _header(client: httpx2.Client) -> str:
    return "; ".join(f"{name}={value}" for name, value in client.cookies.items())


def _load(browser: Browser, url: str, first: FirstPage) -> tuple[float, Wire]:
    """Return when the content was drawn (ms), and everything received until the page was idle."""
    context = browser.new_context(viewport=SIZE, locale="en-US", service_workers="block")
    try:
        context.add_init_script(WHEN_DRAWN.replace("SELECTOR", repr(first.selector)))
        for name, morsel in SimpleCookie(first.cookies).items():
            context.add_cookies([{"name": name, "value": morsel.value, "url": url}])
        page, wire = context.new_page(), Wire()
        wire.attach(page)
        page.goto(url + first.path, wait_until="commit")
        try:
            page.wait_for_function("() => window.drawnAt !== null", timeout=READY_WITHIN_MS)
        except NotInTime as error:
            # For example pages that are rebuilt while they are served.
            told = page.evaluate("() => document.body.innerText")
            raise RuntimeError(f"{first.name} was not drawn; it shows {told!r}") from error
        drawn_ms = float(page.evaluate("window.drawnAt"))
        page.wait_for_timeout(QUIET_MS)
        return drawn_ms, wire
    finally:
        context.close()
