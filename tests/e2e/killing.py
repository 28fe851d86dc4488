"""Crash pages and kill browsers without warning."""

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

import psutil
from playwright.sync_api import Browser, BrowserContext, Error, Page

from tests.support.browser import ARGUMENTS, PATIENCE_MS
from tests.support.chromium_binary import find_chromium


def crash(page: Page) -> None:
    """Crash the page's process."""
    with page.expect_event("crash"), suppress(Error):
        page.goto("chrome://crash")


@contextmanager
def kept_profile(browser: Browser, profile: Path) -> Iterator[BrowserContext]:
    """Run a separate browser whose storage persists in a folder."""
    chromium = find_chromium()
    context = browser.browser_type.launch_persistent_context(
        profile,
        executable_path=chromium.executable,
        args=list(ARGUMENTS),
        env={**os.environ, **chromium.environment},
    )
    context.set_default_timeout(PATIENCE_MS)
    try:
        yield context
    finally:
        with suppress(Error):
            context.close()


def kill_browser(profile: Path) -> None:
    """Send SIGKILL to the browser of this profile, which ends all its processes."""
    for process in psutil.process_iter(["cmdline"]):
        if f"--user-data-dir={profile}" in (process.info["cmdline"] or []):
            with suppress(psutil.NoSuchProcess):
                process.send_signal(signal.SIGKILL)
