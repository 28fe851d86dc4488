"""Browser test of a session whose tasks were skipped: it does not count."""

import csv
import io
import uuid
import zipfile
from collections.abc import Callable

import httpx2
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.features.lab import STUDY, Json, ok
from tests.support.server import ADMIN_PASSWORD, LiveServer


def test_a_session_of_skipped_tasks_does_not_count(
    live_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A session with only skipped tasks is invalid: the cockpit says why, and its slot is free.

    Dashboard and export treat it in the same way.
    """
    with live_server.client() as api:
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        session_id = _skipped(api)
    page = page_factory((1280, 800))
    console = Experimenter(page, live_server.url)
    console.log_in()

    page.goto(f"{live_server.url}/#/sessions/{session_id}")
    console.sees_step("Session completed")
    notice = page.get_by_role("status").filter(has_text="This session does not count")
    expect(notice).to_contain_text("No consent on record")
    expect(notice).to_contain_text("Block 1, hand task: skipped")
    expect(notice).to_contain_text("Block 3, foot task: questionnaire karas2020 not answered")
    assert axe(page) == []
    screenshot(page, "session-not-valid")

    console.open_tab(STUDY, "sessions")
    expect(page.get_by_role("row").filter(has_text="Does not count")).to_be_visible()
    console.open_tab(STUDY, "ledger")
    slot = page.get_by_role("button", name="Next")
    slot.click()
    expect(page.get_by_text("Completed, does not count")).to_be_visible()
    assert axe(page) == []
    screenshot(page, "ledger-not-valid")

    console.open_tab(STUDY, "dashboard")
    told = page.get_by_text("from 0 valid sessions · 1 completed session does not count")
    expect(told).to_be_visible(timeout=PATIENCE_MS)
    console.open_tab(STUDY, "export")
    with page.expect_download(timeout=PATIENCE_MS) as download:
        console.press("Download (zip")
    archive = zipfile.ZipFile(download.value.path())
    [name] = [one for one in archive.namelist() if one.endswith("sessions.csv")]
    [row] = csv.DictReader(io.StringIO(archive.read(name).decode()))
    assert (row["status"], row["valid"]) == ("completed", "false")
    assert row["reasons_not_valid"].startswith(
        "no consent on record; block 1, hand task: skipped; "
    )


def _skipped(api: httpx2.Client) -> str:
    """Create a session of kind people with every step skipped, and return its id."""
    view: Json = ok(api.post(f"/api/studies/{STUDY}/sessions", json={}))
    for kind in ("start", *["skip"] * len(view["steps"])):
        body = {
            "command_id": str(uuid.uuid4()),
            "expected_version": view["version"],
            "type": kind,
            "reason": "nobody was there",
        }
        view = ok(api.post(f"/api/sessions/{view['id']}/commands", json=body))
    assert view["status"] == "completed"
    return str(view["id"])
