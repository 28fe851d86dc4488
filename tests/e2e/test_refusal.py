"""Browser tests of a participant who refuses consent or asks a question."""

from collections.abc import Callable, Iterator

import httpx2
import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter, Participant
from tests.e2e.test_stop_rule import command
from tests.features.lab import STUDY, Json, ok
from tests.support.browser import PageWatch
from tests.support.server import ADMIN_PASSWORD, LiveServer

AGREE, DECLINE = "I agree to take part", "I do not want to take part"
QUESTION, CHANGED = "I have a question", "I have changed my mind"
REFUSED = "The participant does not want to take part"
KNOWS = "The experimenter knows that you do not want to take part"


class Room:
    """The console and tablet of one session at its consent step, and the server."""

    def __init__(self, server: LiveServer, api: httpx2.Client, console: Page, tablet: Page) -> None:
        self.api, self.console, self.tablet = api, console, tablet
        ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
        view = command(api, ok(api.post(f"/api/studies/{STUDY}/sessions", json={})), "start")
        self.session_id = str(view["id"])
        self.experimenter = Experimenter(console, server.url)
        self.experimenter.log_in()
        console.goto(f"{server.url}/#/sessions/{self.session_id}")
        Participant(tablet, server.url).pair(self.experimenter.code_for("tablet"))
        expect(tablet.get_by_role("button", name=AGREE)).to_be_visible(timeout=PATIENCE_MS)

    def log(self) -> list[str]:
        """Return the types of the session's events."""
        events: list[Json] = ok(self.api.get(f"/api/sessions/{self.session_id}/events"))
        return [one["type"] for one in events]

    def refuses(self) -> None:
        """Refuse on the tablet, and wait until the console shows it."""
        self.tablet.get_by_role("button", name=DECLINE).click()
        expect(self.console.get_by_role("heading", name=REFUSED)).to_be_visible(timeout=PATIENCE_MS)


@pytest.fixture
def room(
    running_server: LiveServer, page_factory: Callable[..., Page], page_watch: PageWatch
) -> Iterator[Room]:
    """Provide a session at its consent step, on both screens."""
    page_watch.allow(r"status of 401")
    with running_server.client() as api:
        yield Room(running_server, api, page_factory(), page_factory((1180, 820)))


def test_a_refusal_holds_the_session_until_it_is_ended(
    room: Room, axe: Callable[[Page], list[str]], screenshot: Callable[[Page, str], object]
) -> None:
    """A refusal raises an alarm and hides the agreement button, also after a reload.

    The session stays on hold until the experimenter ends it with a reason.
    """
    console, tablet = room.console, room.tablet
    room.refuses()
    expect(console.get_by_role("alert").first).to_contain_text("Consent refused")
    assert console.title().startswith("▲ Consent refused")
    expect(console.get_by_role("button", name="Signed on paper")).to_have_count(0)
    for _ in range(2):
        expect(tablet.get_by_text(KNOWS)).to_be_visible(timeout=PATIENCE_MS)
        expect(tablet.get_by_role("button", name=AGREE)).to_have_count(0)
        tablet.reload()
    expect(tablet.get_by_text(KNOWS)).to_be_visible(timeout=PATIENCE_MS)
    assert (axe(console), axe(tablet)) == ([], [])
    screenshot(console, "refusal-console")
    screenshot(tablet, "refusal-tablet")
    room.experimenter.press("End the session")
    dialog = console.get_by_role("dialog")
    expect(dialog.get_by_label("Reason")).to_have_value("Refused consent")
    dialog.get_by_role("button", name="Withdraw participant").click()
    room.experimenter.sees_step("Participant withdrawn")
    expect(tablet.get_by_role("heading", name="Thank you for your time")).to_be_visible()
    expect(console.get_by_text("Live", exact=True)).to_have_count(0)
    assert room.log() == ["session_started", "consent_refused", "session_ended"]


def test_a_changed_mind_leads_back_to_the_consent(room: Room) -> None:
    """A participant who changes their mind sees the consent again and may agree.

    They return to it on the tablet, or the experimenter shows it again.
    """
    console, tablet = room.console, room.tablet
    room.refuses()
    tablet.get_by_role("button", name=CHANGED).click()
    expect(tablet.get_by_role("button", name=AGREE)).to_be_visible(timeout=PATIENCE_MS)
    expect(console.get_by_text("Refusal taken back").first).to_be_visible(timeout=PATIENCE_MS)
    expect(console.get_by_role("heading", name=REFUSED)).to_have_count(0)
    room.refuses()
    room.experimenter.press("Show the consent form again")
    dialog = console.get_by_role("dialog")
    dialog.get_by_text("The participant changed their mind").click()
    dialog.get_by_role("button", name="Show the consent form again").click()
    tablet.get_by_role("button", name=AGREE).click()
    expect(tablet.locator("[data-name]").first).to_be_visible(timeout=PATIENCE_MS)
    said = ["consent_refused", "refusal_retracted"]
    assert room.log() == ["session_started", *said, *said, "step_completed"]


def test_a_refusal_without_a_network_is_sent_later(
    room: Room, screenshot: Callable[[Page, str], object], page_watch: PageWatch
) -> None:
    """A refusal made without a network is sent once, when the network is back.

    Meanwhile the tablet asks the participant to tell the experimenter.
    """
    page_watch.allow(r"ERR_INTERNET_DISCONNECTED|Failed to (load|fetch)")
    tablet = room.tablet
    tablet.context.set_offline(True)
    tablet.get_by_role("button", name=DECLINE).click()
    untold = tablet.get_by_text("This tablet cannot reach the experimenter at the moment")
    expect(untold).to_be_visible(timeout=PATIENCE_MS)
    expect(tablet.get_by_role("button", name=AGREE)).to_have_count(0)
    screenshot(tablet, "refusal-tablet-offline")
    assert room.log() == ["session_started"]
    tablet.context.set_offline(False)
    heading = room.console.get_by_role("heading", name=REFUSED)
    expect(heading).to_be_visible(timeout=PATIENCE_MS)
    expect(tablet.get_by_text(KNOWS)).to_be_visible(timeout=PATIENCE_MS)
    assert room.log() == ["session_started", "consent_refused"]


def test_a_question_calls_the_experimenter(
    room: Room, screenshot: Callable[[Page, str], object]
) -> None:
    """A question raises an alarm until the experimenter responds, and the consent stays open."""
    console, tablet = room.console, room.tablet
    tablet.get_by_role("button", name=QUESTION).click()
    called = tablet.get_by_text("The experimenter has been called")
    expect(called).to_be_visible()
    alarm = console.get_by_text("The participant has a question").first
    expect(alarm).to_be_visible(timeout=PATIENCE_MS)
    screenshot(console, "question-console")
    screenshot(tablet, "question-tablet")
    room.experimenter.press("I am here")
    expect(called).to_have_count(0, timeout=PATIENCE_MS)
    expect(console.get_by_text("No alarms")).to_be_visible(timeout=PATIENCE_MS)
    expect(tablet.get_by_role("button", name=AGREE)).to_be_enabled()
    assert room.log() == ["session_started", "question_asked", "question_closed"]


def test_no_key_press_of_the_experimenter_records_a_consent(
    room: Room, screenshot: Callable[[Page, str], object], page_watch: PageWatch
) -> None:
    """No key press of the experimenter records a consent; a paper sheet needs place and reason."""
    page_watch.allow(r"status of 409")
    console = room.console
    console.locator("body").press("Escape")
    console.wait_for_timeout(800)
    for key in ("Enter", "Space"):
        console.keyboard.press(key)
    room.experimenter.press("Signed on paper")
    dialog = console.get_by_role("dialog")
    expect(dialog.get_by_role("button", name="Record the consent")).to_be_disabled()
    assert room.log() == ["session_started"]
    # Another operator was first: this command is rejected, which skipping must not show.
    dialog.get_by_label("Where the sheet is").fill("Folder A, sheet 12")
    dialog.get_by_text("The participant prefers paper").click()
    console.route("**/commands", lambda route: route.fulfill(status=409, json=NOT_NOW))
    dialog.get_by_role("button", name="Record the consent").click()
    expect(dialog.get_by_text(NOT_NOW["error"]["message"])).to_be_visible()
    console.unroute("**/commands")
    dialog.get_by_role("button", name="Cancel").click()
    expect(dialog).to_have_count(0)
    expect(console.get_by_text(NOT_NOW["error"]["message"])).to_have_count(0)
    console.keyboard.press("s")
    expect(dialog.get_by_label("Reason")).to_be_visible()
    expect(dialog.get_by_text(NOT_NOW["error"]["message"])).to_have_count(0)
    screenshot(console, "skip-dialog")
    dialog.get_by_role("button", name="Cancel").click()
    room.experimenter.press("Signed on paper")
    dialog.get_by_label("Where the sheet is").fill("Folder A, sheet 12")
    dialog.get_by_text("The participant prefers paper").click()
    dialog.get_by_role("button", name="Record the consent").click()
    expect(room.tablet.locator("[data-name]").first).to_be_visible(timeout=PATIENCE_MS)
    assert room.log() == ["session_started", "step_completed"]


NOT_NOW: Json = {
    "error": {
        "code": "not_now",
        "message": "the paper has run out",
        "value": None,
        "valid": None,
        "remedy": "Fetch some.",
        "details": [],
    }
}
