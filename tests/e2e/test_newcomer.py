"""Browser test of a new user: a scripted participant, the tour, a download and the storage."""

import re
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.features.lab import ok
from tests.support.server import ADMIN_PASSWORD, LiveServer

STUDY = "reembodiment-latency"
STEPS = 8
IS_UNCOVERED = """element => {
  const {left, top, width, height} = element.getBoundingClientRect()
  return element.contains(document.elementFromPoint(left + width / 2, top + height / 2))
}"""


@pytest.fixture
def fresh_server(tmp_path: Path) -> Iterator[LiveServer]:
    """Provide a server without any session."""
    with LiveServer(tmp_path) as server:
        yield server


def test_a_newcomer_watches_a_session_and_downloads_its_data(
    fresh_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A new user starts a scripted participant, takes the tour, and downloads the data."""
    page = page_factory()
    experimenter = Experimenter(page, fresh_server.url)
    experimenter.log_in()
    experimenter.open_tab(STUDY, "sessions")
    experimenter.press("Try it with a scripted participant")
    page.wait_for_url(re.compile(r"#/sessions/\w+$"), timeout=PATIENCE_MS)
    expect(page.get_by_text(re.compile(r"^SIM-"))).to_be_visible(timeout=PATIENCE_MS)
    _tour(page, axe, screenshot)
    page.keyboard.press("n")
    note = page.locator("#note")
    expect(note).to_be_focused()
    assert note.evaluate(IS_UNCOVERED), "something lies over the field that has the focus"
    page.get_by_role("button", name="Stop", exact=True).click()
    expect(page.get_by_text("The scripted participant was stopped")).to_be_visible(
        timeout=PATIENCE_MS
    )
    expect(page.get_by_role("heading", name="Session aborted")).to_be_visible()
    page.get_by_role("button", name="Close").click()
    _download(page, experimenter, axe, screenshot)
    page.goto(f"{fresh_server.url}/#/storage")
    expect(page.get_by_role("heading", name="Largest sessions")).to_be_visible()
    expect(page.get_by_role("link", name=re.compile("^SIM-"))).to_be_visible()
    assert axe(page) == []
    screenshot(page, "storage")
    with fresh_server.client() as api:
        api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
        kinds = [row["kind"] for row in ok(api.get(f"/api/studies/{STUDY}/sessions"))]
        assert kinds == ["simulated"]
        assert ok(api.get("/api/tryout"))["state"] == "stopped"


def _tour(
    page: Page, axe: Callable[[Page], list[str]], screenshot: Callable[[Page, str], object]
) -> None:
    """Visit every page of the tour with the arrow keys; after Escape the tour does not reopen."""
    callout = page.get_by_role("dialog")
    for number in range(1, STEPS + 1):
        expect(callout.get_by_text(f"{number} of {STEPS}")).to_be_visible()
        if number == 1:
            assert axe(page) == []
            screenshot(page, "tour")
        page.keyboard.press("ArrowRight" if number < STEPS else "ArrowLeft")
    expect(callout.get_by_text(f"{STEPS - 1} of {STEPS}")).to_be_visible()
    page.keyboard.press("Escape")
    expect(callout).to_have_count(0)
    assert page.evaluate("localStorage.getItem('reembody.tour.seen')") == "1"


def _download(
    page: Page,
    experimenter: Experimenter,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """Check that a file is downloaded when it is ready, under its name, and marked in the list."""
    experimenter.open_tab(STUDY, "export")
    page.get_by_role("main").get_by_text("Simulated", exact=True).click()
    with page.expect_download(timeout=PATIENCE_MS) as download:
        experimenter.press("Download (zip")
    name = download.value.suggested_filename
    assert re.fullmatch(rf"reembody_{STUDY}_simulated_tables_\d{{4}}-\d\d-\d\d\.zip", name)
    with zipfile.ZipFile(download.value.path()) as archive:
        assert archive.testzip() is None
        assert archive.read("sessions.csv").count(b"\n") == 1 + 1
    page.get_by_role("button", name="Downloads").click()
    drawer = page.get_by_role("dialog")
    expect(drawer.get_by_text(re.compile("^Handed over to the browser"))).to_be_visible(
        timeout=PATIENCE_MS
    )
    assert axe(page) == []
    screenshot(page, "downloads")
    drawer.get_by_role("button", name="Remove").click()
    expect(drawer.get_by_role("heading", name="No files yet")).to_be_visible()
    page.keyboard.press("Escape")
