"""A browser test of compliance in the joint editor: a leg is made soft, and tried."""

import re
from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.support.browser import in_both_schemes
from tests.support.server import LiveServer

LEG, ARM = "Stiffness of left leg", "Stiffness of left arm"


def changes(page: Page, count: int) -> None:
    """Wait until the page counts so many unsaved changes."""
    text = f"{count} unsaved change{'' if count == 1 else 's'}" if count else "as saved"
    expect(page.get_by_text(text, exact=True)).to_be_visible(timeout=PATIENCE_MS)


def test_a_leg_is_made_soft_on_the_page(
    running_server: LiveServer,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """By keys: stiffness and targets of a group, with marks, an error, undo, mirror and reset.

    What the page makes is what the operation makes.
    """
    page, url = page_factory((1280, 800)), running_server.url
    Experimenter(page, url).log_in()
    page.goto(f"{url}/#/avatars/standard")
    page.get_by_role("tab", name="Body").focus()
    page.keyboard.press("Enter")
    group = page.get_by_role("group", name="Giving way when pushed")
    leg = group.get_by_label(LEG)
    expect(leg).to_have_value("100 %", timeout=PATIENCE_MS)
    mass = page.get_by_label("Total mass")
    mass.fill("0")
    mass.press("Enter")
    expect(page.get_by_text("1 to 500 kg. It is still 72.0 kg.")).to_be_visible()
    changes(page, 0)
    mass.fill("72")
    leg.focus()
    page.keyboard.press("Control+A")
    page.keyboard.type("0")
    page.keyboard.press("Enter")
    refusal = group.get_by_role("alert")
    expect(refusal).to_contain_text("0 % is not possible. Enter 1 to 100 %")
    expect(leg).to_have_attribute("aria-invalid", "true")
    screenshot(page, "avatar-compliance-refused")
    page.keyboard.press("Control+A")
    page.keyboard.type("10")
    page.keyboard.press("Enter")
    changes(page, 1)
    expect(refusal).to_be_hidden()
    expect(group.get_by_text("Saved: 100 %")).to_be_visible()
    returns = group.get_by_role("radiogroup", name="What left leg returns to")
    returns.get_by_role("radio", name="Joint angles").focus()
    page.keyboard.press("ArrowRight")
    changes(page, 2)
    expect(returns.get_by_role("radio", name="Own directions")).to_be_checked()
    expect(group.get_by_text("Saved: Joint angles")).to_be_visible()
    page.keyboard.press("Control+z")
    changes(page, 1)
    page.keyboard.press("Control+Shift+Z")
    changes(page, 2)
    for scheme in in_both_schemes(page):
        group.scroll_into_view_if_needed()
        assert axe(page) == [], scheme
        screenshot(page, f"avatar-compliance-{scheme}")
    page.set_viewport_size({"width": 1180, "height": 820})
    for scheme in in_both_schemes(page):
        group.scroll_into_view_if_needed()
        screenshot(page, f"avatar-compliance-1180-{scheme}")
    # The other leg gets both, and a reset of one leg is of that leg alone.
    page.get_by_role("button", name="Mirror").click()
    page.get_by_role("menuitem", name="Copy left to right").click()
    changes(page, 4)
    told = page.get_by_text("Copy left to right: 2 values of right leg changed.")
    expect(told).to_be_visible()
    page.get_by_role("button", name="Take it back").click()
    changes(page, 2)
    expect(told).to_be_hidden()
    page.get_by_role("button", name="Mirror").click()
    page.get_by_role("menuitem", name="Legs: left to right").click()
    changes(page, 4)
    expect(group.get_by_label("Stiffness of right leg")).to_have_value("10 %")
    page.get_by_role("tab", name="Joints").click()
    page.get_by_role("combobox", name="Edit together").click()
    page.get_by_role("option", name="left leg").click()
    page.get_by_role("combobox", name="What to do").click()
    page.get_by_role("option", name="Reset as shipped").click()
    page.get_by_role("button", name="Apply").click()
    changes(page, 2)
    # A limb with a part that lags cannot return to its own directions, and the page says why.
    page.get_by_role("tab", name="Casts").click()
    page.get_by_label("Delay", exact=True).fill("50")
    page.get_by_role("group", name="Delays").get_by_role("button", name="Apply").click()
    page.get_by_role("tab", name="Body").click()
    expect(group.get_by_text(re.compile("left arm: a part of it has a delay"))).to_be_visible()
    arm = group.get_by_role("radiogroup", name="What left arm returns to")
    expect(arm.get_by_role("radio", name="Own directions")).to_be_disabled()
    group.get_by_role("button", name="Make everything stiff").click()
    expect(group.get_by_label("Stiffness of right leg")).to_have_value("100 %")
    expect(group.get_by_role("button", name="Make everything stiff")).to_be_disabled()
