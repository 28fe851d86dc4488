"""Browser tests of the cockpit by keyboard, from the pre-flight to the live picture."""

import re
from collections.abc import Callable

from playwright.sync_api import Locator, Page, ViewportSize, expect

from app.features.movement.avatar import SHIPPED, version_of
from app.models import StudySession
from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.e2e.test_first_study import STUDY, short_study
from tests.e2e.wearer import Wearer
from tests.features.lab import ok
from tests.features.record.headset.site import Site
from tests.protocol.helpers import edited
from tests.support.browser import in_both_schemes

PRESSED_EVERY_MS, LOOKED_EVERY_MS = 800.0, 200.0
LONGER, TASK_S = "cockpit-study", 600
"""Long enough for the page to be looked at while the task runs, however slow the machine is."""
SIZES: tuple[ViewportSize, ...] = (
    {"width": 1280, "height": 800},
    {"width": 1180, "height": 820},
)


def test_a_start_needs_a_reason_and_the_movement_is_drawn(
    headset_site: Site,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """Starting without a tablet asks for a reason; boxes and a body with skin move on the page.

    Clock, buttons and picture are on the screen together, running and paused; at the end the
    receipt says what is stored.
    """
    yaml = short_study(TASK_S).replace(f"key: {STUDY}", f"key: {LONGER}", 1)
    ok(headset_site.operator.post("/api/studies", json={"yaml": yaml}))
    view = ok(headset_site.operator.post(f"/api/studies/{LONGER}/sessions", json={}))
    session_id = str(view["id"])
    with headset_site.database.writing() as db:
        # The scripted headset does not simulate; the console draws the body all the same.
        newest = version_of(db, SHIPPED, None)
        db.get_one(StudySession, session_id).avatar_configuration_hash = newest.content_hash
    code = ok(
        headset_site.operator.post(
            f"/api/sessions/{session_id}/pairings", json={"device": "headset"}
        )
    )["code"]
    page = page_factory((1280, 800))
    console = Experimenter(page, headset_site.server.url)
    console.log_in()
    with Wearer(headset_site.server.url, code) as wearer:
        page.goto(f"{headset_site.server.url}/#/sessions/{session_id}")
        connected = page.locator('[data-check="headset"]').get_by_text("Paired and connected")
        expect(connected).to_be_visible(timeout=PATIENCE_MS)
        expect(page.locator('[data-check="tablet"]')).to_contain_text("Failed")
        assert axe(page) == []
        screenshot(page, "preflight")
        dialog = page.get_by_role("dialog", name="Start despite failed checks")
        _press_until_it_opens(page, dialog)
        expect(dialog.get_by_label("Reason")).to_be_focused()
        page.keyboard.type("Answers are asked aloud")
        page.keyboard.press("Enter")
        console.sees_step("Consent")
        types = [one["type"] for one in ok(headset_site.operator.get(_events(session_id)))]
        assert types == ["check_overridden", "session_started"]
        _walk_to_the_hand_task(headset_site, session_id)
        picture = page.locator("[data-pictures]")
        expect(picture).to_have_attribute("data-lit", "", timeout=PATIENCE_MS)
        headset_site.command(session_id, "begin_phase")
        lit = page.locator('[data-lit*="hand/"]')
        expect(lit).to_be_visible(timeout=PATIENCE_MS)
        expect(picture).to_have_attribute("data-pictures", re.compile(r"^[1-9]"))
        expect(page.locator("[data-drawn=skin]")).to_be_visible(timeout=PATIENCE_MS)
        page.keyboard.press("1")
        expect(page.get_by_role("radio", name="First person")).to_be_checked()
        for state in ("Running", "Paused"):
            if state == "Paused":
                headset_site.command(session_id, "pause")
            expect(page.locator("[data-tour=step]")).to_contain_text(state)
            for size in SIZES:
                page.set_viewport_size(size)
                for shown in (page.get_by_role("timer"), _skip(page), picture):
                    _sees_whole(shown, size)
        for size in SIZES:
            page.set_viewport_size(size)
            for scheme in in_both_schemes(page):
                assert axe(page) == [], (size, scheme)
                screenshot(page, f"cockpit-live-{size['width']}-{scheme}")
        headset_site.command(session_id, "abort", reason="seen enough")
        _reads_the_receipt(page, axe, screenshot)
    assert wearer.error is None


def _skip(page: Page) -> Locator:
    """Return the button that skips the step, one of the last among the controls."""
    return page.locator("[data-tour=step]").get_by_role("button", name="Skip")


def _sees_whole(shown: Locator, size: ViewportSize) -> None:
    """Require that something is on the screen as a whole without scrolling.

    The page may be drawn anew for a size some time after it was given that size.
    """
    for _ in range(int(PATIENCE_MS / LOOKED_EVERY_MS)):
        box = shown.bounding_box()
        assert box is not None
        if box["y"] >= 0 and box["y"] + box["height"] <= size["height"]:
            return
        shown.page.wait_for_timeout(LOOKED_EVERY_MS)
    raise AssertionError((shown, box, size))


def _reads_the_receipt(
    page: Page, axe: Callable[[Page], list[str]], screenshot: Callable[[Page, str], object]
) -> None:
    """Open the receipt by its button: both bodies and the reports, with nothing missing."""
    page.get_by_role("button", name="Receipt of the record").click()
    drawer = page.get_by_role("dialog", name="Receipt of the record")
    for stream in ("Participant's body", "Avatar's body", "Reports"):
        row = drawer.get_by_role("row", name=stream)
        expect(row).to_contain_text(re.compile(r"1[1-9][\d,]* (frames|reports)"))
    expect(drawer).to_contain_text("every hash follows from the one before")
    for scheme in in_both_schemes(page):
        assert axe(page) == [], scheme
        screenshot(page, f"receipt-{scheme}")
    page.keyboard.press("Escape")


def test_an_operator_changes_the_avatar_by_keyboard(
    headset_site: Site,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """An operator puts an arm in a cast; the panel says that the headset has done it.

    The event log has the change in words, and going back to the study's settings takes it back.
    """
    key = "avatar-in-a-cast"
    physics = "avatar: physics\navatar_configuration: {key: standard, version: 1}"
    text = edited(("key: reembodiment-latency", f"key: {key}"), ("avatar: delayed_copy", physics))
    ok(headset_site.operator.post("/api/studies", json={"yaml": text}))
    session_id = str(ok(headset_site.operator.post(f"/api/studies/{key}/sessions", json={}))["id"])
    pairing = headset_site.operator.post(
        f"/api/sessions/{session_id}/pairings", json={"device": "headset"}
    )
    page = page_factory((1280, 800))
    console = Experimenter(page, headset_site.server.url)
    console.log_in()
    with Wearer(headset_site.server.url, ok(pairing)["code"]) as wearer:
        headset_site.skip_to(session_id, "materialise")
        page.goto(f"{headset_site.server.url}/#/sessions/{session_id}")
        panel = page.get_by_role("region", name="Avatar settings")
        # Loading the simulation takes a while.
        expect(panel).to_contain_text("As the study configures them", timeout=4 * PATIENCE_MS)
        page.keyboard.press("b")
        dialog = page.get_by_role("dialog", name="Change the avatar's settings")
        dialog.get_by_role("button", name="Add").first.click()
        dialog.get_by_role("combobox", name="Body group or part").press_sequentially("left arm")
        page.keyboard.press("Enter")
        chosen = dialog.get_by_role("combobox", name="Body group or part")
        expect(chosen).to_have_value("left arm")
        # The list is closed: the part was chosen, and not only typed.
        expect(chosen).to_have_attribute("aria-expanded", "false")
        assert axe(page) == []
        screenshot(page, "avatar-settings")
        dialog.get_by_role("button", name="Apply").click()
        expect(panel).to_contain_text("cast: left arm")
        expect(panel).to_contain_text("In force on the headset", timeout=PATIENCE_MS)
        expect(page.locator("[data-tour=live]")).to_contain_text("In a cast")
        # Keys do nothing while a dialog is there, also one that is just closing.
        expect(page.get_by_role("dialog")).to_have_count(0)
        page.keyboard.press("l")
        expect(page.get_by_role("dialog", name="Event log")).to_contain_text("cast: left arm")
        page.keyboard.press("Escape")
        panel.get_by_role("button", name="Back to the study's settings").click()
        expect(panel).to_contain_text("As the study configures them")
        headset_site.command(session_id, "abort", reason="seen enough")
    assert wearer.error is None


def _press_until_it_opens(page: Page, dialog: Locator) -> None:
    """Press Enter until the dialog opens, as the key is ignored after a change or while loading."""
    for _ in range(int(PATIENCE_MS / PRESSED_EVERY_MS)):
        page.keyboard.press("Enter")
        page.wait_for_timeout(PRESSED_EVERY_MS)
        if dialog.is_visible():
            return


def _events(session_id: str) -> str:
    return f"/api/sessions/{session_id}/events"


def _walk_to_the_hand_task(site: Site, session_id: str) -> None:
    """Skip the steps before the avatar, let it appear, and skip to the hand task."""
    while True:
        view = site.view(session_id)
        step = view["steps"][view["current"]["index"]]
        if step["key"] == "block1.hand":
            return
        if step["kind"] == "materialise":
            site.command(session_id, "materialise")
        else:
            site.command(session_id, "skip", reason="not in this test")
