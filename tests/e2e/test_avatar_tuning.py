"""A browser test of tuning: order, crash, go on, two people, accept and reject, and compare."""

import re
from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, PICTURE_HIDDEN, Experimenter
from tests.features.movement.captures.files import walk_bvh
from tests.support.browser import PageWatch, in_both_schemes
from tests.support.server import LiveServer

TUNED_MS = 120_000
AVATAR = "tuned_twin"
ELBOW = "left elbow: bend"


def copied_avatar(page: Page, url: str) -> None:
    """Store a copy of the shipped avatar, so that this test has one of its own."""
    shipped = page.request.get(f"{url}/api/avatars/standard").json()["newest"]
    new = {"key": AVATAR, "title": "Tuned twin", "origin": "by_hand"}
    answer = page.request.post(
        f"{url}/api/avatars", data=new | {"configuration": shipped["configuration"]}
    )
    assert answer.ok, answer.text()


def opened(page: Page, url: str) -> None:
    """Open the avatar's tab Tuning."""
    page.goto(f"{url}/#/avatars/{AVATAR}")
    page.get_by_role("tab", name="Tuning").click(timeout=PATIENCE_MS)
    expect(page.get_by_role("form", name="Order a tuning")).to_be_visible(timeout=PATIENCE_MS)


def choose(page: Page, field: str, option: str) -> None:
    """Choose an option of a list."""
    page.get_by_role("combobox", name=field, exact=True).click()
    page.get_by_role("option", name=option, exact=True).click()


def test_a_tuning_survives_crashes_and_colleagues(
    page_watch: PageWatch,
    screenshot: Callable[[Page, str], object],
    axe: Callable[[Page], list[str]],
    page_factory: Callable[..., Page],
    running_server: LiveServer,
) -> None:
    """A tuning goes on after the server's crash; what is accepted stays true to the work.

    A colleague sees it, and its end; a stored capture shows error and torque before and after.
    """
    # The server is away for a while, and a tuning that was discarded is asked for once more.
    page_watch.allow(r"status of 404|ERR_CONNECTION|Failed to load resource")
    page, url = page_factory((1280, 800)), running_server.url
    Experimenter(page, url).log_in()
    copied_avatar(page, url)
    opened(page, url)
    crashed_and_resumed(page, running_server)
    accepted_and_rejected(page, axe, screenshot)
    compared(page, url, axe, screenshot)
    colleague = page_factory((1180, 820))
    Experimenter(colleague, url).log_in()
    discarded_by_a_colleague(page, colleague, url, axe, screenshot)


def crashed_and_resumed(page: Page, server: LiveServer) -> None:
    """Tune both arms; the server crashes on the way, and resuming ends with all axes."""
    form = page.get_by_role("form", name="Order a tuning")
    choose(page, "Axes", "left arm")
    expect(form.get_by_role("button", name="Tune 8 axes")).to_be_enabled()
    form.get_by_label("Tune the left, copy to the right").check()
    form.get_by_label("Time-out for an axis").fill("601")
    expect(form.get_by_text("0.01 to 600 s")).to_be_visible()
    start = form.get_by_role("button", name="Tune 16 axes")
    expect(start).to_be_disabled()
    form.get_by_label("Time-out for an axis").fill("10")
    start.click()
    panel = page.get_by_role("region", name="Tuning", exact=True)
    expect(panel.get_by_role("status").first).to_be_visible(timeout=PATIENCE_MS)
    server.kill()
    server.start()
    # It may have been ready before the crash; then there is nothing to go on with.
    state = panel.get_by_text(re.compile(r"^(Stopped|Ready)"))
    expect(state).to_be_visible(timeout=TUNED_MS)
    if state.inner_text().startswith("Stopped"):
        expect(state).to_contain_text("of 16 axes have been measured, and that is kept")
        panel.get_by_role("button", name="Go on").click()
    expect(panel.get_by_text("Ready: 16 axes have new gains.")).to_be_visible(timeout=TUNED_MS)
    expect(panel.get_by_text("copied from left elbow: bend")).to_be_visible()


def accepted_and_rejected(
    page: Page, axe: Callable[[Page], list[str]], screenshot: Callable[[Page, str], object]
) -> None:
    """Reject all, accept all, take over, undo, come back, and put a single axis back."""
    panel = page.get_by_role("region", name="Tuning", exact=True)
    panel.get_by_role("button", name="Reject all").click()
    expect(panel.get_by_text("0 of 16 accepted")).to_be_visible()
    expect(panel.get_by_role("button", name="Take over 0 axes")).to_be_disabled()
    panel.get_by_role("button", name="Accept all").click()
    panel.get_by_role("button", name="Take over 16 axes").click()
    taken = panel.get_by_text("Taken over into your work")
    expect(taken).to_be_visible(timeout=PATIENCE_MS)
    # The button has gone, and the focus stays in the panel.
    expect(panel).to_be_focused()
    page.get_by_role("button", name="Undo").click()
    expect(panel.get_by_role("button", name="Take over 16 axes")).to_be_enabled()
    page.get_by_role("button", name="Redo").click()
    expect(taken).to_be_visible()
    # Coming back from another tab forgets nothing.
    page.get_by_role("tab", name="Casts").click()
    page.get_by_role("tab", name="Tuning").click()
    expect(taken).to_be_visible(timeout=PATIENCE_MS)
    page.get_by_role("checkbox", name=f"Accept {ELBOW}").uncheck()
    expect(panel.get_by_text("15 of 16 accepted")).to_be_visible()
    screenshot(page, "tuning-put-back")
    panel.get_by_role("button", name="Put 1 axis back").click()
    expect(panel.get_by_role("button", name="Put 1 axis back")).to_be_hidden()
    page.get_by_role("checkbox", name=f"Accept {ELBOW}").check()
    panel.get_by_role("button", name="Take over 1 axis").click()
    expect(taken).to_be_visible(timeout=PATIENCE_MS)
    # What else was changed since is listed.
    page.get_by_role("tab", name="Body").click()
    page.get_by_label("Gravity").click()
    page.get_by_role("tab", name="Tuning").click()
    expect(
        page.get_by_text("Your work differs from what was tuned in 1 other value").first
    ).to_be_visible(timeout=PATIENCE_MS)
    assert axe(page) == []
    screenshot(page, "tuning-differs")
    page.get_by_role("button", name="Undo").click()
    expect(page.get_by_text("Your work differs from what was tuned")).to_have_count(0)


def compared(
    page: Page,
    url: str,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """Compare on a capture of the lab: error and torque by group and by axis, with differences."""
    panel = page.get_by_role("region", name="Compare on a movement")
    has_one = any(
        one["has_skeleton"] for one in page.request.get(f"{url}/api/captures").json()["captures"]
    )
    if not has_one:
        expect(panel.get_by_role("link", name="Add a capture")).to_be_visible()
    sent = page.request.post(f"{url}/api/captures?name=tuning-walk.bvh", data=walk_bvh(90))
    short = page.request.post(f"{url}/api/captures?name=tuning-blink.bvh", data=walk_bvh(15))
    titles = [one.json()["title"] for one in (sent, short)]
    page.reload()
    page.get_by_role("tab", name="Tuning").click(timeout=PATIENCE_MS)
    choose_capture = panel.get_by_role("combobox")
    for title in (titles[1], titles[0]):
        expect(panel).to_be_visible(timeout=PATIENCE_MS)
        choose_capture.click()
        page.get_by_role("option", name=title).click()
        panel.get_by_role("button", name="Compare before and after").click()
        if title == titles[1]:
            expect(panel.get_by_role("alert")).to_contain_text("0.47 s long", timeout=TUNED_MS)
            expect(panel.get_by_role("link", name="Open this capture")).to_be_visible()
            screenshot(page, "tuning-too-short")
    each = panel.get_by_role("region", name="Error and torque in an empty space")
    arm = each.get_by_role("row", name=re.compile("^left arm "))
    expect(arm).to_be_visible(timeout=TUNED_MS)
    expect(each.get_by_role("columnheader", name=re.compile(r"\((°|N m)\)$"))).to_have_count(2)
    expect(arm).to_have_text(re.compile(r"^left arm(−?\d+\.\d\d|< 0\.005|> −0\.005){6}$"))
    panel.get_by_text("By axis", exact=True).click()
    expect(each.get_by_role("row")).to_have_count(2 + 89)
    panel.get_by_text("By body group", exact=True).click()
    page.evaluate(PICTURE_HIDDEN)
    for scheme in in_both_schemes(page):
        assert axe(page) == [], scheme
        arm.scroll_into_view_if_needed()
        screenshot(page, f"tuning-compared-{scheme}")
    page.get_by_role("button", name="Reject all").click()
    expect(panel.get_by_text("Accept an axis to compare.")).to_be_visible()
    expect(panel.get_by_text("You have changed what is accepted since.")).to_be_visible()
    page.get_by_role("button", name="Accept all").click()


def discarded_by_a_colleague(
    page: Page,
    colleague: Page,
    url: str,
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """A colleague finds the tuning beside the avatar, and discards it; both pages say so."""
    opened(colleague, url)
    known = colleague.get_by_role("region", name="Other tunings of this avatar")
    expect(known).to_contain_text(re.compile("ready.*16 axes · version 1"), timeout=PATIENCE_MS)
    colleague.evaluate(PICTURE_HIDDEN)
    screenshot(colleague, "tuning-known")
    known.get_by_role("button", name="Show").click()
    expect(colleague.get_by_text("16 of 16 accepted")).to_be_visible(timeout=PATIENCE_MS)
    for scheme in in_both_schemes(colleague):
        assert axe(colleague) == [], scheme
        screenshot(colleague, f"tuning-1180-{scheme}")
    colleague.get_by_role("button", name="Discard this tuning").click()
    # It asks first, and keeping is what Enter does.
    expect(colleague.get_by_role("button", name="Keep it")).to_be_focused()
    colleague.get_by_role("button", name="Discard it").press("Enter")
    expect(colleague.get_by_role("region", name="Tuning", exact=True)).to_have_count(0)
    gone = page.get_by_text("Somebody has discarded this tuning.")
    expect(gone).to_be_visible(timeout=PATIENCE_MS)
    screenshot(page, "tuning-gone")
    page.get_by_role("button", name="Close").click()
    expect(gone).to_be_hidden()
