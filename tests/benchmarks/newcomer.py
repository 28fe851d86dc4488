"""What a newcomer reaches in a real browser, in clicks and seconds, from a server of their own.

`first_figure`: from an empty server by one click to a figure with title, n, units and interval.
`cockpit`: from the first page to the desk of a session that runs. `tables`: twelve sessions as CSV.
Typing the password is not counted. With `REEMBODY_SCREENSHOTS=FOLDER` the end of each is drawn.
"""

import os
import re
import tempfile
import time
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from playwright.sync_api import Browser, Locator, Page, ViewportSize

from tests.benchmarks.report import Figure, Report
from tests.benchmarks.thousand import shipped_database, summaries_of
from tests.features.builders import STUDY, SessionSpec, build_session
from tests.support.browser import launched_browser, take_screenshot
from tests.support.server import ADMIN_PASSWORD, LiveServer

PARTS = ("first_figure", "cockpit", "tables")
SCREENSHOTS_VARIABLE = "REEMBODY_SCREENSHOTS"
SESSIONS = 12
PATIENCE_MS = 300_000.0
FIGURE_WITHIN_S, TABLES_WITHIN_S = 60.0, 10.0
# A caption that says of how many people, and a point with its interval.
DESCRIBED = re.compile(r"\bn = [2-9]|\bn = \d\d|(?:[2-9]|\d\d) participants", re.IGNORECASE)
INTERVAL = re.compile(r"95\s?% (?:BCa )?(?:confidence )?(?:interval|CI)|interval", re.IGNORECASE)
UNITS = re.compile(r"\(.+\)|ms|points|deg")


@dataclass
class Newcomer:
    """Somebody with a mouse; `clicks` counts what they pressed."""

    page: Page
    clicks: int = 0

    def click(self, target: Locator) -> None:
        """Press something that is on the page."""
        self.clicks += 1
        target.click(timeout=PATIENCE_MS)

    def button(self, name: str) -> Locator:
        """Return the first button with this name."""
        return self.page.get_by_role("button", name=name).first


def measure(parts: frozenset[str]) -> Report:
    """Take the named ways, each from its own server."""
    report = Report("newcomer")
    ways = {"first_figure": _first_figure, "cockpit": _cockpit, "tables": _tables}
    with (
        tempfile.TemporaryDirectory(prefix="reembody-bench-") as scratch,
        launched_browser() as browser,
    ):
        for part in PARTS:
            if part in parts:
                report.add(*ways[part](browser, Path(scratch) / part))
    return report


def _first_figure(browser: Browser, folder: Path) -> Iterator[Figure]:
    with LiveServer(folder) as server, _signed_in(browser, server) as newcomer:
        page, began_s = newcomer.page, time.monotonic()
        newcomer.click(newcomer.button("Load the demo lab"))
        described = page.get_by_role("figure").filter(has_text=DESCRIBED).filter(has_text=INTERVAL)
        figure = described.filter(has=page.locator(".js-plotly-plot .xtick")).first
        figure.wait_for(timeout=PATIENCE_MS)
        took_s = time.monotonic() - began_s
        title = figure.get_by_role("heading").inner_text()
        axes = " ".join(figure.locator(".xtitle, .ytitle").all_text_contents())
        _draw(page, "newcomer-first-figure")
    part = "first_figure"
    yield Figure(part, "one click to the first figure", took_s, "s", "limit", FIGURE_WITHIN_S)
    yield Figure(part, "clicks", newcomer.clicks, "", "limit", 1)
    yield Figure(
        part, "title and units", int(bool(title and UNITS.search(axes))), "", "at least", 1
    )


def _cockpit(browser: Browser, folder: Path) -> Iterator[Figure]:
    with LiveServer(folder) as server, _signed_in(browser, server) as newcomer:
        began_s = time.monotonic()
        newcomer.click(newcomer.button("Watch a session live"))
        newcomer.page.wait_for_url(re.compile(r"#/sessions/\w+$"), timeout=PATIENCE_MS)
        newcomer.page.get_by_text(re.compile("^SIM-")).first.wait_for(timeout=PATIENCE_MS)
        took_s = time.monotonic() - began_s
        _draw(newcomer.page, "newcomer-cockpit")
    yield Figure("cockpit", "clicks", newcomer.clicks, "", "limit", 3)
    yield Figure("cockpit", "first page to cockpit", took_s, "s")


def _tables(browser: Browser, folder: Path) -> Iterator[Figure]:
    server = LiveServer(folder)
    database = shipped_database(server.data_dir)
    with database.writing() as db:
        for at in range(SESSIONS):
            built = build_session(db, SessionSpec(f"SIM-{at:04d}", kind="simulated"))
            db.add_all(summaries_of(db, built))
    database.close()
    with server, _signed_in(browser, server) as newcomer:
        page, began_s = newcomer.page, time.monotonic()
        newcomer.click(page.get_by_role("link", name="Export", exact=True))
        newcomer.click(page.get_by_role("main").get_by_text("Simulated", exact=True))
        with page.expect_download(timeout=PATIENCE_MS) as download:
            newcomer.click(newcomer.button("Download (zip"))
        path = download.value.path()
        took_s = time.monotonic() - began_s
        with zipfile.ZipFile(path) as archive:
            rows = archive.read("sessions.csv").count(b"\n") - 1
            wide = archive.read("wide.csv").count(b"\n") - 1
        _draw(page, "newcomer-tables")
    yield Figure("tables", "clicks", newcomer.clicks, "", "limit", 3)
    yield Figure("tables", "first page to tables", took_s, "s", "limit", TABLES_WITHIN_S)
    yield Figure("tables", f"sessions of {STUDY} in sessions.csv", rows, "", "at least", SESSIONS)
    yield Figure("tables", "participants in wide.csv", wide, "", "at least", SESSIONS)


@contextmanager
def _signed_in(browser: Browser, server: LiveServer) -> Iterator[Newcomer]:
    context = browser.new_context(
        viewport=ViewportSize(width=1280, height=800), locale="en-US", service_workers="block"
    )
    try:
        page = context.new_page()
        page.goto(server.url)
        page.get_by_label("User name").fill("admin")
        page.get_by_label("Password", exact=True).fill(ADMIN_PASSWORD)
        page.keyboard.press("Enter")
        page.get_by_role("heading", name="Studies").wait_for(timeout=PATIENCE_MS)
        yield Newcomer(page)
    finally:
        context.close()


def _draw(page: Page, name: str) -> None:
    chosen = os.environ.get(SCREENSHOTS_VARIABLE)
    if chosen:
        take_screenshot(page, Path(chosen), name)
