"""Wait until a page is idle: no request of the page is pending.

Going from `#/a` to `#/b` loads no document, so the browser's own "network idle" stays true all the
time and waits for nothing.
"""

import time
from dataclasses import dataclass, field

from playwright.sync_api import Page, Request

LOOK_EVERY_MS = 60.0
QUIET_LOOKS = 4
"""A page that has just loaded its code requests its data a moment later."""
ENDLESS = "/live"


@dataclass
class Traffic:
    """Track the pending requests of `page`, from its creation on."""

    page: Page
    _on_the_way: set[Request] = field(default_factory=set)

    def __post_init__(self) -> None:
        """Start to track requests."""
        self.page.on("request", self._asked)
        self.page.on("requestfinished", self._over)
        self.page.on("requestfailed", self._over)

    def settle(self, within_s: float = 30.0) -> None:
        """Wait until no request has been pending for a moment; raises TimeoutError."""
        until_s, quiet = time.monotonic() + within_s, 0
        while quiet < QUIET_LOOKS:
            if time.monotonic() > until_s:
                waiting = sorted(request.url for request in self._on_the_way)
                raise TimeoutError(f"{self.page.url} still waits for {waiting}")
            self.page.wait_for_timeout(LOOK_EVERY_MS)
            quiet = 0 if self._on_the_way else quiet + 1

    def _asked(self, request: Request) -> None:
        if not request.url.endswith(ENDLESS):
            self._on_the_way.add(request)

    def _over(self, request: Request) -> None:
        self._on_the_way.discard(request)
