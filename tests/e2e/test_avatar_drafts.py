"""A browser test of unsaved work on an avatar: of two tabs, refused, continued and discarded."""

from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.support.browser import PageWatch
from tests.support.server import LiveServer

AVATAR = "#/avatars/standard"
TAKE = "Continue with them"
KNEE = "LeftLowerLegX"


def edited(page: Page, address: str, column: int, value: str) -> None:
    """Open an avatar and give the left knee another value."""
    page.goto(address)
    cell = page.locator(f"[data-row='{KNEE}'][data-column='{column}']")
    cell.dblclick(timeout=PATIENCE_MS)
    page.keyboard.type(value)
    page.keyboard.press("Enter")
    expect(page.get_by_text("1 unsaved change", exact=True)).to_be_visible(timeout=PATIENCE_MS)


def test_unsaved_work_is_lost_neither_to_another_tab_nor_to_a_refusal(
    page_factory: Callable[..., Page],
    running_server: LiveServer,
    screenshot: Callable[[Page, str], object],
    axe: Callable[[Page], list[str]],
    page_watch: PageWatch,
) -> None:
    """The work of two tabs is offered; what the server does not accept stays until discarded."""
    page_watch.allow(r"Failed to load resource|ERR_FAILED")
    first, url = page_factory((1280, 800)), running_server.url
    Experimenter(first, url).log_in()
    second = first.context.new_page()
    edited(first, f"{url}/{AVATAR}", 4, "111")
    edited(second, f"{url}/{AVATAR}", 5, "7")
    page = first.context.new_page()
    first.close()
    second.close()
    page.goto(f"{url}/{AVATAR}")
    take = page.get_by_role("button", name=TAKE)
    expect(take).to_have_count(2, timeout=PATIENCE_MS)
    screenshot(page, "avatar-drafts")
    assert axe(page) == []
    page.route("**/api/avatars/edit", lambda route: route.abort())
    take.first.click()
    expect(page.get_by_text("The server is not responding")).to_be_visible(timeout=PATIENCE_MS)
    expect(take).to_have_count(2)
    page.unroute("**/api/avatars/edit")
    take.first.click()
    expect(take).to_have_count(1, timeout=PATIENCE_MS)
    expect(page.locator("[data-row='LeftLowerLegX'][data-column='5']")).to_contain_text("7")
    page.reload()
    expect(take).to_have_count(2, timeout=PATIENCE_MS)
    page.get_by_role("button", name="Discard them").first.click()
    page.get_by_role("button", name="Discard them").first.click()
    expect(take).to_have_count(0)


def test_unsaved_work_goes_on_from_its_own_version_and_stays_its_owners(
    page_factory: Callable[..., Page],
    running_server: LiveServer,
    screenshot: Callable[[Page, str], object],
    axe: Callable[[Page], list[str]],
    page_watch: PageWatch,
) -> None:
    """Of a draft over a colleague's version the own change is saved; no time or room is no end."""
    page_watch.allow(r"Failed to load resource")
    page, url = page_factory((1280, 800)), running_server.url
    Experimenter(page, url).log_in()
    api = page.request
    shipped = api.get(f"{url}/api/avatars/standard").json()["newest"]["configuration"]
    made = {"key": "drafted", "title": "Drafted", "origin": "by_hand", "configuration": shipped}
    assert api.post(f"{url}/api/avatars", data=made).status == 201
    edited(page, f"{url}/#/avatars/drafted", 4, "111")
    theirs = {"based_on": 1, "origin": "by_hand", "note": "Lighter."}
    theirs["configuration"] = {**shipped, "total_mass_kg": 60}
    assert api.post(f"{url}/api/avatars/drafted/versions", data=theirs).status == 201
    # What cannot be a time does not keep the page from opening; what is another's is not offered.
    page.evaluate(
        """() => {
            const key = Object.keys(localStorage).find((one) => one.includes("avatar.drafted/"));
            const draft = JSON.parse(localStorage.getItem(key));
            localStorage.setItem(`${key}-odd`, JSON.stringify({ ...draft, at: "xx" }));
            localStorage.setItem(`${key}-other`, JSON.stringify({ ...draft, by: "somebody" }));
        }"""
    )
    page.reload()
    take = page.get_by_role("button", name=TAKE)
    expect(take).to_have_count(2, timeout=PATIENCE_MS)
    expect(page.get_by_text("from version 1; version 2 has been saved since")).to_have_count(2)
    take.first.click()
    expect(page.get_by_text("1 unsaved change", exact=True)).to_be_visible(timeout=PATIENCE_MS)
    expect(page.get_by_text("version 2 is newer")).to_be_visible()
    page.keyboard.press("Control+s")
    dialog = page.get_by_role("dialog")
    dialog.get_by_role("button", name="Save").focus()
    page.keyboard.press("Control+z")
    dialog.get_by_role("button", name="Save").click()
    expect(dialog.get_by_text("Somebody saved this avatar")).to_be_visible(timeout=PATIENCE_MS)
    screenshot(page, "avatar-draft-conflict")
    assert axe(page) == []
    dialog.get_by_role("button", name="Put your changes onto version 2").click()
    dialog.get_by_role("button", name="Save").click()
    expect(page.get_by_text("as saved", exact=True)).to_be_visible(timeout=PATIENCE_MS)
    saved = api.get(f"{url}/api/avatars/drafted").json()["newest"]
    assert saved["number"] == 3
    assert saved["configuration"]["total_mass_kg"] == 60
    assert saved["configuration"]["axes"][KNEE]["kp_nm_per_rad"] == 111
    page.evaluate("() => { Storage.prototype.setItem = () => { throw new Error('full'); }; }")
    page.locator(f"[data-row='{KNEE}'][data-column='4']").dblclick()
    page.keyboard.type("55")
    page.keyboard.press("Enter")
    expect(page.get_by_text("does not keep your unsaved changes")).to_be_visible(
        timeout=PATIENCE_MS
    )
    page.goto(f"{url}/#/avatars/drafted/99")
    page.reload()
    expect(page.get_by_text("Drafted has no version 99.")).to_be_visible(timeout=PATIENCE_MS)
