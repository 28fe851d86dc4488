"""Browser test of a companion: chosen in the cockpit, seen by the participant, hidden again."""

import time
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, PICTURE_HIDDEN, Experimenter
from tests.features.lab import ok
from tests.features.movement.performers.senders import by_json, part_of_walk
from tests.features.record.headset.site import Site
from tests.support.acting_on_screen import act_on_this_screen
from tests.support.datagrams import HERE, free_udp_port, sending


def drawn_calls(desk: Page) -> int:
    """Return the draw calls of the newest picture."""
    calls: int = desk.evaluate("globalThis.reembody.drawn.calls")
    return calls


def drawn_until(desk: Page, matches: Callable[[int], bool]) -> None:
    """Wait until a picture takes as many draw calls as expected."""
    until_s = time.monotonic() + PATIENCE_MS / 1000
    while not matches(drawn_calls(desk)):
        assert time.monotonic() < until_s
        desk.wait_for_timeout(100)


# The rules are tests of their own (session/scenery.test.ts, features/record/companion): this draws
# the whole way without a graphics card, which takes half a minute.
@pytest.mark.long
def test_a_performer_stands_before_the_participant(
    headset_site: Site,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """Whoever acts on this screen sees the performer, until the experimenter stops showing them."""
    port = free_udp_port()
    door = {"is_open": True, "interface": HERE, "port": port}
    ok(headset_site.operator.put("/api/trackers/doors/json", json=door))
    walk = list(by_json(part_of_walk(50, 110)))
    page = page_factory((1280, 800))
    page.add_init_script(PICTURE_HIDDEN)
    Experimenter(page, headset_site.server.url).log_in()
    with sending(port, lambda number: walk[number % len(walk)]):
        acted = act_on_this_screen(page)
        drawn = drawn_calls(acted.desk)
        panel = page.get_by_role("region", name="Companion")
        panel.get_by_label("Performer").select_option("mime, Hips", timeout=PATIENCE_MS)
        panel.get_by_label("Place").select_option("ahead on the left")
        panel.scroll_into_view_if_needed()
        assert axe(page) == []
        screenshot(page, "companion-chosen")
        panel.get_by_role("button", name="Show to the participant").click()
        expect(panel.get_by_text("The participant sees the companion now")).to_be_visible(
            timeout=PATIENCE_MS
        )
        expect(panel.get_by_text("Poses stored")).to_be_visible(timeout=PATIENCE_MS)
        drawn_until(acted.desk, lambda calls: calls > drawn)
        screenshot(acted.desk, "companion-seen")
        panel.scroll_into_view_if_needed()
        assert axe(page) == []
        screenshot(page, "companion")
        panel.get_by_role("button", name="Stop showing").click()
        expect(panel.get_by_role("button", name="Stop showing")).to_be_hidden()
        drawn_until(acted.desk, lambda calls: calls <= drawn)
    ok(headset_site.operator.put("/api/trackers/doors/json", json={**door, "is_open": False}))
