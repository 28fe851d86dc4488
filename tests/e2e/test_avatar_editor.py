"""Browser tests of the joint editor: an avatar is made, edited, saved, and used in a study.

The same journey by mouse and by keyboard alone, and what each of them can do besides.
"""

import json
import re
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.hands import Hand, Keys, Mouse, cell
from tests.e2e.people import PATIENCE_MS, PICTURE_HIDDEN
from tests.features.lab import ok
from tests.protocol.helpers import STUDY as FILE
from tests.support.browser import PageWatch, in_both_schemes
from tests.support.server import ADMIN_PASSWORD, LiveServer

TUNED_MS = 120_000
CLICKS = 6
"""From the first page to a softer knee that is seen to follow a step."""
KNEE = "LeftLowerLegX"
TABS = ("Body", "Collisions", "Casts and delays", "Versions and files")


@dataclass
class Looks:
    """Looks at a page in both colour schemes: for pictures, and with `axe` for accessibility."""

    page: Page
    screenshot: Callable[[Page, str], object]
    axe: Callable[[Page], list[str]] | None

    def at(self, name: str) -> None:
        """Look at what is shown now."""
        width = (self.page.viewport_size or {"width": 0})["width"]
        for scheme in in_both_schemes(self.page):
            if self.axe is not None:
                assert self.axe(self.page) == [], f"{name}, {scheme}"
            self.screenshot(self.page, f"avatar-{name}-{width}-{scheme}")


@pytest.fixture
def study(running_server: LiveServer) -> Callable[[str], str]:
    """Provide a function that stores a study of this title and returns its key."""

    def stored(title: str) -> str:
        key = title.lower().replace(" ", "-")
        text = FILE.replace("key: reembodiment-latency", f"key: {key}", 1)
        text = text.replace("en: Acting through another body", f"en: {title}", 1)
        with running_server.client() as api:
            ok(api.post("/api/login", json={"username": "admin", "password": ADMIN_PASSWORD}))
            ok(api.post("/api/studies", json={"yaml": text}))
        return key

    return stored


def changes(page: Page, count: int) -> None:
    """Wait until the page counts so many unsaved changes."""
    text = f"{count} unsaved change{'' if count == 1 else 's'}" if count else "as saved"
    expect(page.get_by_text(text, exact=True).first).to_be_visible(timeout=PATIENCE_MS)


# The same way by keyboard is part of every run.
@pytest.mark.long
def test_an_avatar_is_made_and_used_by_mouse(
    running_server: LiveServer,
    page_factory: Callable[..., Page],
    page_watch: PageWatch,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
    study: Callable[[str], str],
) -> None:
    """By mouse an avatar is tuned, converted, put in a cast, saved, and used by a session.

    Every tab and dialog is accessible, light and dark. Somebody else's version is not lost, nor
    is one's own work beside it. A softer knee takes a newcomer six clicks.
    """
    page_watch.allow(r"status of 4(01|09|22)")
    page, url = page_factory((1280, 800)), running_server.url
    looks = Looks(page, screenshot, axe)
    made_and_used(Mouse(page), url, "Softer knee", study("Soft study"), looks)
    many_at_once(page, url)
    saved_meanwhile(page, page.context.new_page(), url, looks)
    assert clicks_to_a_softer_knee(page, url) <= CLICKS


def test_an_avatar_is_made_and_used_by_keyboard_alone(
    running_server: LiveServer,
    page_factory: Callable[..., Page],
    page_watch: PageWatch,
    screenshot: Callable[[Page, str], object],
    study: Callable[[str], str],
) -> None:
    """Without a mouse the same avatar is made and used, and the focus is never lost."""
    page_watch.allow(r"status of 4(01|22)")
    page, url = page_factory((1180, 820)), running_server.url
    keys = Keys(page)
    looks = Looks(page, screenshot, None)
    made_and_used(keys, url, "Stiffer knee", study("Stiff study"), looks)
    sys.stderr.write(f"{keys.presses} keys without texts\n")
    like_a_spreadsheet(keys, url)


def made_and_used(hand: Hand, url: str, title: str, study_key: str, looks: Looks) -> None:
    """New configuration, tune an arm, mirror, convert and back, cast a hand, save, use, see."""
    page = hand.page
    page.add_init_script(PICTURE_HIDDEN)
    hand.log_in(url)
    hand.press(page.get_by_role("link", name="Avatars"))
    hand.press(page.get_by_role("button", name="New avatar"))
    expect(page.get_by_role("heading", name="Avatars")).to_be_visible(timeout=PATIENCE_MS)
    hand.write(page.get_by_label("Name"), title)
    looks.at("new")
    hand.press(page.get_by_role("button", name="Create avatar"))
    expect(page.get_by_role("heading", name=title)).to_be_visible(timeout=PATIENCE_MS)
    expect(page.locator("[data-way=space]")).to_be_visible(timeout=PATIENCE_MS)
    # The button that made it is gone: the keyboard goes on in the editor.
    expect(page.get_by_role("tab", name="Joints")).to_be_focused()
    # The knee has two axes; the chosen one is drawn last.
    expect(page.locator("canvas")).to_have_attribute(
        "data-arcs", f"LeftLowerLegY {KNEE}", timeout=PATIENCE_MS
    )
    hand.set_cell(KNEE, 4, "50")
    changes(page, 1)
    expect(cell(page, KNEE, 4)).to_have_text("50")
    tuned_arm(hand, looks)
    hand.pick(page.get_by_role("button", name="Mirror"), "Copy left to right")
    hand.open_tab("Joints")
    hand.switch("Changed")
    expect(cell(page, "RightLowerLegX", 4)).to_have_text("50", timeout=PATIENCE_MS)
    looks.at("changed")
    hand.switch("All")
    converted(hand, looks)
    hand.open_tab("Casts and delays")
    hand.press(page.get_by_role("button", name="Put a cast on"))
    expect(page.get_by_role("list", name="Casts")).to_contain_text(
        "left hand", ignore_case=True, timeout=PATIENCE_MS
    )
    for tab in TABS:
        hand.open_tab(tab)
        looks.at(tab.split()[0].lower())
    hand.open_tab("Collisions")
    hand.flip("Collisions between body parts")
    expect(page.get_by_role("checkbox", name="right arm · left arm")).to_be_disabled()
    looks.at("no-collisions")
    hand.press(page.get_by_role("button", name="Undo"))
    hand.save()
    hand.write(page.get_by_label("Note"), "The knees give way.")
    looks.at("save")
    hand.press(page.get_by_role("dialog").get_by_role("button", name="Save"))
    changes(page, 0)
    expect(page.get_by_role("status").get_by_text("Version 2")).to_be_visible()
    saved = page.request.get(f"{url}/api/avatars/{key_of(title)}").json()["newest"]
    assert saved["note"] == "The knees give way."
    assert saved["configuration"]["locked_groups"] == ["LeftHand"]
    assert saved["configuration"]["axes"]["RightLowerLegX"]["kp_nm_per_rad"] == 50
    used_in_a_study(hand, title, study_key, saved["content_hash"], looks)


def key_of(title: str) -> str:
    """Return the key that the page makes from a title."""
    return title.lower().replace(" ", "_")


def tuned_arm(hand: Hand, looks: Looks) -> None:
    """Tune the left arm, look at a response, reject an axis, and take the others over."""
    page = hand.page
    hand.open_tab("Tuning")
    hand.choose(page.get_by_role("combobox", name="Axes"), "left arm")
    hand.press(page.get_by_role("button", name=re.compile("^Tune ")))
    expect(page.get_by_text(re.compile(r"^Ready: "))).to_be_visible(timeout=TUNED_MS)
    hand.press(page.get_by_role("button", name="left elbow: bend"))
    response = page.get_by_role("region", name="left elbow: bend: Step response")
    expect(response.locator(".main-svg").first).to_be_visible(timeout=PATIENCE_MS)
    looks.at("tuning")
    hand.press(page.get_by_role("checkbox", name="Accept left shoulder: turn"))
    hand.press(page.get_by_role("button", name=re.compile("^Take over ")))
    expect(page.get_by_text("Taken over into your work")).to_be_visible(timeout=PATIENCE_MS)


def converted(hand: Hand, looks: Looks) -> None:
    """Convert to one joint per part, which says first what is lost, and back; then undo it."""
    page = hand.page
    hand.switch("Joint per part")
    lost = page.get_by_role("dialog", name="One joint per body part")
    expect(lost.get_by_role("row", name=re.compile("left knee: turn"))).to_contain_text("2545")
    looks.at("lost")
    # Nothing is converted by Enter alone.
    expect(lost.get_by_role("button", name="Keep them")).to_be_focused()
    hand.press(lost.get_by_role("button", name="Convert"))
    expect(page.get_by_role("columnheader", name="Limit Y")).to_be_visible(timeout=PATIENCE_MS)
    # What was changed is told here, too.
    knee = page.locator("[data-row=LeftLowerLeg][data-changed]").first
    expect(knee).to_have_attribute("title", re.compile("^Was "), timeout=PATIENCE_MS)
    looks.at("single")
    hand.switch("Joint per axis")
    # Symmetric now: the greater of 45 and 25 degrees.
    expect(cell(page, "LeftLowerLegY", 3)).to_have_text("45", timeout=PATIENCE_MS)
    hand.press(page.get_by_role("button", name="Undo"))
    expect(cell(page, "LeftLowerLegY", 3)).to_have_text("25", timeout=PATIENCE_MS)


def used_in_a_study(
    hand: Hand, title: str, study_key: str, content_hash: str, looks: Looks
) -> None:
    """Name the version in a study, and come back to it from the hash on a session."""
    page, version = hand.page, f"{title}, version 2"
    study_title = study_key.replace("-", " ").capitalize()
    hand.press(page.get_by_role("button", name="Use in a study", exact=True))
    hand.choose(page.get_by_role("combobox", name="Study"), study_title)
    looks.at("use")
    hand.press(page.get_by_role("button", name="Open in the study editor"))
    chosen = page.get_by_role("combobox", name="Avatar and version")
    expect(chosen).to_have_value(version, timeout=PATIENCE_MS)
    expect(page.get_by_text(content_hash[:12]).first).to_be_visible(timeout=PATIENCE_MS)
    expect(chosen).to_be_in_viewport(ratio=1)
    looks.at("study")
    hand.press(page.get_by_role("button", name="Save as a version"))
    expect(page.get_by_text("Saved as version 2")).to_be_visible(timeout=PATIENCE_MS)
    hand.press(page.get_by_role("link", name="Reembody"))
    hand.press(page.get_by_role("link", name=study_title).first)
    hand.press(page.get_by_role("button", name="New session").first)
    hand.press(page.get_by_role("button", name="Create session"))
    way = page.get_by_role("link", name=f"avatar {version}")
    expect(way).to_be_visible(timeout=PATIENCE_MS)
    expect(page.get_by_text(content_hash[:8], exact=True).first).to_be_visible()
    looks.at("session")
    hand.press(way)
    expect(page.get_by_role("tab", name="Versions and files", selected=True)).to_be_visible(
        timeout=PATIENCE_MS
    )
    current = page.locator("[aria-current=true]")
    expect(current).to_contain_text(content_hash[:12], timeout=PATIENCE_MS)
    used = page.get_by_role("region", name="Used by").get_by_role("listitem")
    mine = used.filter(has_text=study_title)
    expect(mine).to_contain_text(re.compile("Version 2 · 1 session.*frozen"), timeout=PATIENCE_MS)
    expect(page.get_by_role("status").get_by_text("frozen")).to_be_visible(timeout=PATIENCE_MS)
    looks.at("used")


def many_at_once(page: Page, url: str) -> None:
    """Edit the axes that were clicked together, after errors that say what is valid."""
    page.goto(f"{url}/#/avatars/softer_knee")
    changes(page, 0)
    cell(page, "LeftFootX", 0).click()
    cell(page, "LeftFootY", 0).click()
    page.get_by_role("combobox", name="Edit together").click()
    page.get_by_role("option", name="2 selected axes").click()
    page.get_by_label("N m/rad").fill("-3")
    page.get_by_role("button", name="Apply").click()
    refused = page.get_by_role("alert").filter(has_text="The request is not")
    expect(refused).to_be_visible(timeout=PATIENCE_MS)
    page.get_by_label("N m/rad").fill("300")
    page.get_by_role("button", name="Apply").click()
    changes(page, 2)
    undo = page.get_by_role("button", name="Undo")
    undo.click()
    changes(page, 0)
    # It is switched off by its own press, and keeps the focus.
    expect(undo).to_be_disabled()
    expect(undo).to_be_focused()
    Mouse(page).set_cell(KNEE, 2, "179")
    page.get_by_role("button", name="Understood").click(timeout=PATIENCE_MS)
    expect(page.get_by_role("tab", name="Joints")).to_be_focused()
    changes(page, 0)


def like_a_spreadsheet(keys: Keys, url: str) -> None:
    """Leave an edit, undo and redo, and edit several axes, as in a spreadsheet; save with keys."""
    page = keys.page
    page.goto(f"{url}/#/avatars/stiffer_knee")
    knee = cell(page, KNEE, 4)
    expect(knee).to_have_text("50", timeout=PATIENCE_MS)
    keys.go_to_cell(KNEE, 4)
    keys.hit("Enter")
    keys.hit("Escape")
    expect(knee).to_be_focused()
    page.keyboard.type("-50")
    keys.hit("Enter")
    wrong = page.get_by_role("treegrid").get_by_role("alert")
    expect(wrong).to_have_text("Enter a number from 0 to 1,000,000 (N m/rad).")
    page.keyboard.press("Control+a")
    page.keyboard.type("80")
    keys.hit("Enter")
    changes(page, 1)
    expect(knee).to_have_text("80")
    keys.hit("Control+z")
    changes(page, 0)
    keys.hit("Control+Shift+Z")
    changes(page, 1)
    # The focus went on to the next axis: both of the knee's are selected and edited together.
    keys.hit("Space")
    keys.hit("ArrowUp")
    keys.hit("Space")
    page.keyboard.type("90")
    keys.hit("Enter")
    expect(cell(page, "LeftLowerLegY", 4)).to_have_text("90", timeout=PATIENCE_MS)
    expect(knee).to_have_text("90")
    # A needle is dragged by its slider.
    slider = page.get_by_role("slider", name=re.compile("left knee: bend"))
    keys.go_to(slider)
    keys.hit("ArrowRight")
    expect(slider).to_have_value("1")
    keys.save()
    keys.hit("Escape")
    expect(slider).to_be_focused(timeout=PATIENCE_MS)
    keys.save()
    keys.write(page.get_by_label("Note"), "By keyboard.")
    keys.press(page.get_by_role("dialog").get_by_role("button", name="Save"))
    changes(page, 0)
    expect(page.get_by_role("status").get_by_text("Version 3")).to_be_visible()
    expect(slider).to_be_focused(timeout=PATIENCE_MS)
    # What was saved can still be undone.
    keys.hit("Control+z")
    changes(page, 2)


def saved_meanwhile(first: Page, second: Page, url: str, looks: Looks) -> None:
    """Two people edit the same version: the second to save sees the other's, and keeps both."""
    for page in (first, second):
        page.goto(f"{url}/#/avatars/softer_knee")
        page.reload()
        changes(page, 0)
    for page, value in ((second, "60"), (first, "70")):
        cell(page, KNEE, 4).dblclick()
        page.keyboard.type(value)
        page.keyboard.press("Enter")
        changes(page, 1)
        page.keyboard.press("Control+s")
        page.get_by_role("dialog").get_by_role("button", name="Save").click()
        if page is second:
            changes(page, 0)
    dialog = first.get_by_role("dialog")
    conflict = dialog.get_by_text("Somebody saved this avatar")
    expect(conflict).to_be_visible(timeout=PATIENCE_MS)
    row = dialog.get_by_role("row", name=re.compile("left knee: bend")).last
    expect(row).to_contain_text("60")
    expect(row).to_contain_text("70")
    looks.at("conflict")
    first.get_by_role("button", name="Save yours after it, as version 4").click()
    changes(first, 0)
    history = first.request.get(f"{url}/api/avatars/softer_knee").json()["versions"]
    assert [one["number"] for one in history] == [4, 3, 2, 1], json.dumps(history)


def clicks_to_a_softer_knee(page: Page, url: str) -> int:
    """Make the left knee softer as a newcomer would, see what it does, and count the clicks."""
    page.goto(url)
    avatars = page.get_by_role("link", name="Avatars")
    expect(avatars).to_be_visible(timeout=PATIENCE_MS)
    began = time.perf_counter()
    avatars.click()
    page.get_by_role("link", name="Standard").click()
    knee = cell(page, KNEE, 4)
    expect(knee).to_be_visible(timeout=PATIENCE_MS)
    knee.dblclick()
    page.keyboard.type("100")
    page.keyboard.press("Enter")
    changes(page, 1)
    page.get_by_role("tab", name="Try").click()
    # What was just edited is what is tried, though Enter went on to the next row.
    axis = page.get_by_role("combobox", name="Joint axis")
    expect(axis).to_have_value("left knee: bend", timeout=PATIENCE_MS)
    page.get_by_text("Step", exact=True).click()
    # The simulation runs in the page, with what is not saved yet.
    expect(page.get_by_text(re.compile(r"[1-9][\d.]* s simulated"))).to_be_visible(
        timeout=PATIENCE_MS
    )
    # The last of the curves is seen without scrolling, beside the body.
    torque = page.get_by_role("img", name=re.compile("^Torque as a curve"))
    expect(torque).to_be_in_viewport(ratio=1)
    clicks = 2 + 2 + 2
    seconds = time.perf_counter() - began
    sys.stderr.write(f"a softer knee: {clicks} clicks, {seconds:.1f} s of the page\n")
    return clicks
