"""Headless Chromium, and pages whose errors fail the test.

A page whose console fills with errors is broken even if it seems to work: every context created
here reports console errors and uncaught exceptions to one `PageWatch`, and the test fails at its
end unless it declared that it expects them.
"""

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from playwright.sync_api import Browser, BrowserContext, ConsoleMessage, Page, sync_playwright

from tests.support.chromium_binary import axe_script, find_chromium
from tests.support.node import NODE
from tests.support.server import LiveServer
from tests.support.unit_tests import needs

ColorScheme = Literal["light", "dark"]
Motion = Literal["reduce", "no-preference"]
DESKTOP = (1280, 800)
PATIENCE_MS = 60_000
"""How long a page may take for what is asked of it on a slow machine; no test judges its speed."""
ARGUMENTS = (
    # Chromium's own sandbox does not work for root, nor inside most containers.
    "--no-sandbox",
    # No look-ups of its makers' hosts: on a closed network they fail slowly, on an open one they
    # do not belong in a test.
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-quic",
    "--disable-sync",
    "--no-first-run",
    # WebGL 2 in software, for the headset's page.
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--ignore-gpu-blocklist",
    "--disable-gpu-compositing",
    "--disable-gpu-rasterization",
)


@contextmanager
def launched_browser() -> Iterator[Browser]:
    """Run a headless Chromium while the block runs."""
    needs("a browser")
    chromium = find_chromium()
    # Playwright's own Node needs a library that bare machines lack.
    os.environ.setdefault("PLAYWRIGHT_NODEJS_PATH", str(NODE))
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(
            executable_path=chromium.executable,
            args=list(ARGUMENTS),
            env={**os.environ, **chromium.environment},
        )
        try:
            yield browser
        finally:
            browser.close()


@dataclass
class PageWatch:
    """Collect the errors that the pages of one test report."""

    problems: list[str] = field(default_factory=list)
    _allowed: list[re.Pattern[str]] = field(default_factory=list)

    def allow(self, pattern: str) -> None:
        """Allow problems that match this regular expression, e.g. `status of 409`."""
        self._allowed.append(re.compile(pattern))

    def attach(self, context: BrowserContext) -> None:
        """Watch every current and future page of the context."""
        context.on("console", self._on_console)
        context.on("weberror", lambda error: self.problems.append(f"uncaught: {error.error}"))

    def unexpected(self) -> list[str]:
        """Return the problems that were not allowed."""
        return [
            problem
            for problem in self.problems
            if not any(pattern.search(problem) for pattern in self._allowed)
        ]

    def _on_console(self, message: ConsoleMessage) -> None:
        if message.type == "error":
            address = message.location.get("url", "")
            self.problems.append(f"console: {message.text} ({address})")


@dataclass(frozen=True)
class ContextFactory:
    """Create browser contexts (each with its own cookies and storage) and close them."""

    browser: Browser
    watch: PageWatch

    def __call__(
        self,
        size: tuple[int, int] = DESKTOP,
        color_scheme: ColorScheme = "light",
        locale: str = "en-US",
        motion: Motion = "reduce",
        **options: Any,  # Playwright's own, such as base_url or has_touch
    ) -> BrowserContext:
        """Return a watched context; `size` is width and height in CSS pixels.

        Animations are rendered in software, which is slow, so they are disabled, as for people who
        prefer reduced motion; `motion="no-preference"` enables animations.
        """
        width, height = size
        context = self.browser.new_context(
            viewport={"width": width, "height": height},
            color_scheme=color_scheme,
            locale=locale,
            reduced_motion=motion,
            **options,
        )
        context.set_default_timeout(PATIENCE_MS)
        self.watch.attach(context)
        return context


@contextmanager
def watched_contexts(browser: Browser, watch: PageWatch) -> Iterator[ContextFactory]:
    """Yield a factory whose contexts are closed, and whose pages' errors are raised, at the end."""
    before = set(browser.contexts)
    try:
        yield ContextFactory(browser, watch)
    finally:
        for context in browser.contexts:
            if context not in before:
                context.close()
    unexpected = watch.unexpected()
    told = "\n".join([*unexpected, LiveServer.logs_of_running()])
    assert not unexpected, f"the pages reported errors:\n{told}"


def in_both_schemes(page: Page) -> Iterator[ColorScheme]:
    """Show the current page in dark and then in light mode, without repeating the steps to it."""
    schemes: tuple[ColorScheme, ...] = ("dark", "light")
    for scheme in schemes:
        page.emulate_media(color_scheme=scheme)
        yield scheme


def take_screenshot(page: Page, folder: Path, name: str) -> Path:
    """Save the whole page as `folder/name.png`, without animations."""
    path = folder / f"{name}.png"
    page.screenshot(path=path, full_page=True, animations="disabled")
    return path


# A changed theme or an opening drawer starts to move a frame or two later, and is done when
# nothing has moved for a few frames. A paused or endlessly repeated animation would never end, so
# the wait is limited.
MOVEMENTS_DONE = """async () => {
    const until = performance.now() + 30000;
    let calm = 0;
    while (calm < 4 && performance.now() < until) {
        await new Promise((next) => requestAnimationFrame(next));
        const moving = document.getAnimations().some((one) => one.playState === "running"
            && Number.isFinite(one.effect?.getComputedTiming().endTime));
        calm = moving ? 0 : calm + 1;
    }
}"""


# No rule that is enabled by default needs style sheets to be fetched again.
RUN_AXE = "axe.run(document, { resultTypes: ['violations'], preload: false })"


def accessibility_violations(page: Page) -> list[str]:
    """Return the serious and critical violations that axe-core finds on the page, one per line."""
    # A drawer that is still opening has paler colours than at rest.
    page.evaluate(MOVEMENTS_DONE)
    # Inject it once per document: the engine would compile it again each time. Evaluated, not
    # added as an element, so that the page's content security policy stays on.
    if not page.evaluate("'axe' in window"):
        page.evaluate(axe_script().read_text(encoding="utf-8"))
    result = page.evaluate(RUN_AXE)
    return [
        f"{violation['id']} ({violation['impact']}): {violation['help']}: "
        + "; ".join(" ".join(map(str, node["target"])) for node in violation["nodes"])
        for violation in result["violations"]
        if violation["impact"] in {"serious", "critical"}
    ]
