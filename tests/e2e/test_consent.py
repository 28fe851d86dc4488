"""Browser tests of consent that is drawn, typed, printed or given on paper."""

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import Experimenter, Participant
from tests.protocol.options import KEY, with_options
from tests.support.browser import PageWatch
from tests.support.server import ADMIN_PASSWORD, LiveServer

GO = "I agree to take part"
KEPT_AFTER_MS = 600.0
READ, TAKE_PART, LATER = (
    "I have read the page above.",
    "I agree to take part.",
    "My data may be used in later studies.",
)


@pytest.fixture
def pages(
    running_server: LiveServer, page_factory: Callable[..., Page], page_watch: PageWatch
) -> tuple[Experimenter, Participant]:
    """Provide a started session of the study with a signed consent, and its tablet."""
    page_watch.allow(r"status of 401")
    with running_server.client() as api:
        api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD})
        if api.get(f"/api/studies/{KEY}").status_code == 404:
            added = api.post("/api/studies", json={"yaml": with_options()})
            assert added.status_code == 201, added.text
    console, tablet = page_factory((1280, 800)), page_factory((1180, 820))
    experimenter = Experimenter(console, running_server.url)
    participant = Participant(tablet, running_server.url)
    experimenter.log_in()
    experimenter.open_tab(KEY)
    experimenter.create_session()
    participant.pair(experimenter.code_for("tablet"))
    experimenter.start()
    expect(participant.page.get_by_role("button", name=GO)).to_be_visible()
    return experimenter, participant


def shown_signature(page: Page) -> str:
    """Return the strokes drawn on the signature area."""
    return page.locator("svg[role=img] path").first.get_attribute("d") or ""


def sign(page: Page) -> None:
    """Draw two strokes with the mouse."""
    surface = page.get_by_role("img", name="Area for signing with a finger, pen or mouse")
    surface.scroll_into_view_if_needed()
    box = surface.bounding_box()
    assert box is not None
    for points in (((60, 120), (120, 40), (180, 120)), ((240, 60), (320, 110), (400, 50))):
        page.mouse.move(box["x"] + points[0][0], box["y"] + points[0][1])
        page.mouse.down()
        for x, y in points[1:]:
            page.mouse.move(box["x"] + x, box["y"] + y, steps=8)
        page.mouse.up()


def test_a_drawn_signature_is_recorded(
    pages: tuple[Experimenter, Participant],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A signed consent needs every required line, survives a reload and is displayed in full.

    The consent record contains all of it.
    """
    experimenter, participant = pages
    tablet, console = participant.page, experimenter.page
    tablet.get_by_role("button", name=GO).click()
    expect(tablet.get_by_text("Please tick every statement that is not optional.")).to_be_visible()
    for line in (READ, TAKE_PART):
        tablet.get_by_label(line).check()
    tablet.get_by_role("button", name=GO).click()
    expect(tablet.get_by_text("Please sign in the area above.")).to_be_visible()
    sign(tablet)
    tablet.get_by_role("button", name="Clear").click()
    tablet.get_by_role("button", name=GO).click()
    expect(tablet.get_by_text("Please sign in the area above.")).to_be_visible()
    sign(tablet)
    drawn = shown_signature(tablet)
    # Wait until it is stored: a stroke changes it many times a second.
    tablet.wait_for_timeout(KEPT_AFTER_MS)
    tablet.reload()
    expect(tablet.get_by_label(TAKE_PART)).to_be_checked()
    expect(tablet.get_by_label(LATER)).not_to_be_checked()
    assert shown_signature(tablet) == drawn != ""
    assert axe(tablet) == []
    screenshot(tablet, "consent-tablet")
    tablet.get_by_role("button", name=GO).click()
    expect(tablet.locator("[data-name]").first).to_be_visible()
    console.get_by_role("link", name="Consent").click()
    expect(console.get_by_role("img", name="Signature drawn on the tablet")).to_be_visible()
    record = console.get_by_role("article")
    for words in ("Thank you for coming.", READ, TAKE_PART, LATER, "Acting through another body"):
        expect(record.get_by_text(words).first).to_be_visible()
    assert record.get_by_text("not agreed", exact=True).count() == 1
    assert record.get_by_text("agreed", exact=True).count() == 2
    expect(record.get_by_text("P-0001")).to_be_visible()
    assert axe(console) == []
    screenshot(console, "consent-record")
    console.emulate_media(media="print")
    expect(console.get_by_role("button", name="Print")).to_be_hidden()
    expect(console.get_by_role("navigation")).to_be_hidden()
    assert console.pdf(format="A4").startswith(b"%PDF")
    console.emulate_media(media="screen")


def test_consent_can_be_signed_by_keyboard(
    pages: tuple[Experimenter, Participant],
) -> None:
    """A participant can consent by keyboard alone, typing their name."""
    experimenter, participant = pages
    tablet, console = participant.page, experimenter.page
    for line in (READ, TAKE_PART):
        tablet.get_by_label(line).focus()
        tablet.keyboard.press("Space")
    tablet.get_by_role("button", name="Type my name instead").focus()
    tablet.keyboard.press("Enter")
    tablet.get_by_label("First and last name").focus()
    tablet.keyboard.type("Ada Lovelace")
    tablet.keyboard.press("Enter")
    expect(tablet.locator("[data-name]").first).to_be_visible()
    console.get_by_role("link", name="Consent").click()
    expect(console.get_by_text("Ada Lovelace")).to_be_visible()


def test_a_sheet_of_paper_is_recorded_by_the_experimenter(
    pages: tuple[Experimenter, Participant],
) -> None:
    """A consent on paper is recorded with its place and reason, and the tablet continues."""
    experimenter, participant = pages
    console = experimenter.page
    experimenter.press("Signed on paper")
    dialog = console.get_by_role("dialog")
    dialog.get_by_label("Where the sheet is").fill("Folder A, sheet 12")
    dialog.get_by_text("The participant prefers paper").click()
    dialog.get_by_role("button", name="Record the consent").click()
    expect(participant.page.locator("[data-name]").first).to_be_visible()
    console.get_by_role("link", name="Consent").click()
    expect(console.get_by_text("Folder A, sheet 12")).to_be_visible()
