"""Browser tests of an alarm on the console."""

import re
import time
from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter
from tests.faults.figures import note
from tests.features.record.headset.site import Site
from tests.features.record.headset.streaming import in_free_movement, materialised
from tests.support.browser import in_both_schemes


def test_an_alarm_is_raised_and_cleared(
    headset_site: Site,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """An alarm appears, can be acknowledged, clears, and stays in the list.

    The alarm is raised by a headset that stops sending in a phase. The other parts of the page do
    not move when it appears.
    """
    experimenter = Experimenter(page_factory((1280, 800)), headset_site.server.url)
    page, session_id = experimenter.page, materialised(headset_site)
    experimenter.log_in()
    page.goto(f"{headset_site.server.url}/#/sessions/{session_id}")
    strip = page.get_by_label("Signal and alarms")
    with headset_site.headset(headset_site.token(session_id)) as headset:
        streamer = in_free_movement(headset_site, session_id, headset)
        with streamer.streaming(running=True, probing=True):
            expect(strip).to_contain_text(
                "Movement is arriving and being stored", timeout=PATIENCE_MS
            )
            expect(strip).to_contain_text(re.compile(r"90 Hz"), timeout=PATIENCE_MS)
            before = strip.bounding_box()
        alarm = strip.get_by_role("alert")
        expect(alarm).to_contain_text("Headset not responding", timeout=PATIENCE_MS)
        seen_after_s = time.monotonic() - streamer.last_sent_s
        note(14, "headset falls silent", "alarm seen in a browser after (s)", seen_after_s)
        expect(alarm).to_contain_text("The phase is paused", timeout=PATIENCE_MS)
        expect(page).to_have_title(re.compile("Headset not responding"))
        assert strip.bounding_box() == before
        for scheme in in_both_schemes(page):
            assert axe(page) == [], scheme
            screenshot(page, f"alarm-silent-{scheme}")
        page.reload()
        expect(alarm).to_contain_text("Headset not responding", timeout=PATIENCE_MS)
        experimenter.press("Understood")
        expect(alarm).to_contain_text("Headset not responding")
        for scheme in in_both_schemes(page):
            assert axe(page) == [], scheme
        with streamer.streaming(running=True, probing=True):
            expect(strip).to_contain_text("No alarms", timeout=PATIENCE_MS)
        page.keyboard.press("a")
        drawer = page.get_by_role("dialog")
        expect(drawer.get_by_role("row", name=re.compile("Headset not responding"))).to_be_visible()
        for scheme in in_both_schemes(page):
            assert axe(page) == [], scheme
            screenshot(page, f"alarm-history-{scheme}")
