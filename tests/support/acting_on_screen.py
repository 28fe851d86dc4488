"""The shortest way from the console's first page into a body that mouse and keyboard move."""

import time
from dataclasses import dataclass

from playwright.sync_api import Locator, Page

PATIENCE_MS = 60_000
WITHIN_MS = 30
"""How often the page is asked how far it is."""


@dataclass(frozen=True)
class Acted:
    """The tab in which the body is acted with, and what it took to get there."""

    desk: Page
    clicks: int
    took_s: float


def act_on_this_screen(console: Page) -> Acted:
    """Act with a body on this screen, beginning at the console's first page.

    Acting has begun when the body is entered and has followed a key: the participant has walked
    forwards, and the frames of it are recorded. Keys are not clicks: the space bar steps into the
    body, as both grips do in a headset.
    """
    clicks = 0

    def click(place: Locator) -> None:
        nonlocal clicks
        place.click(timeout=PATIENCE_MS)
        clicks += 1

    began_s = time.monotonic()
    click(console.get_by_role("button", name="Help", exact=True))
    with console.expect_popup(timeout=PATIENCE_MS) as opened:
        click(console.get_by_role("menuitem", name="Act on this screen"))
    desk = opened.value
    until(desk, "globalThis.reembody?.place === 'stepping_in'")
    desk.keyboard.down("Space")
    until(desk, "reembody.place === 'acting' && reembody.computed !== null")
    desk.keyboard.up("Space")
    stood_m = float(desk.evaluate(HIPS_Z_M))
    desk.keyboard.down("KeyW")
    until(desk, f"reembody.recorded > 0 && {HIPS_Z_M} < {stood_m} - 0.05")
    desk.keyboard.up("KeyW")
    return Acted(desk, clicks, time.monotonic() - began_s)


HIPS_Z_M = "reembody.computed.remote[2]"
"""The root position's z of the body that is acted with, m; forwards is -z."""


def until(page: Page, condition: str) -> None:
    """Wait until a JavaScript expression is true, without waiting for frames."""
    page.wait_for_function(f"() => {condition}", polling=WITHIN_MS, timeout=PATIENCE_MS)
