"""Browser test of the headset page's pairing: links that are opened again, and a second headset."""

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS
from tests.features.record.headset.site import Site
from tests.support.browser import ContextFactory, PageWatch
from tests.support.vr_visit import ok


def test_a_link_pairs_one_browser_and_a_second_headset_replaces_the_first(
    headset_site: Site, new_context: ContextFactory, page_watch: PageWatch
) -> None:
    """A link works once, and leads the browser that it has paired back to its session.

    Elsewhere it says that it was used. Whoever pairs with a new code takes the headset's place, and
    the first one says so and stays out, also when it is loaded again.
    """
    page_watch.allow(r"status of 4\d\d|WebSocket connection to .* failed")
    operator, url = headset_site.operator, headset_site.server.url
    path = "/api/studies/reembodiment-latency/sessions"
    session_id = str(ok(operator.post(path, json={"kind": "test"}))["id"])

    def link() -> str:
        paired = operator.post(f"/api/sessions/{session_id}/pairings", json={"device": "headset"})
        return f"{url}/vr?code={ok(paired)['code']}"

    def is_paired(page: Page) -> None:
        expect(page.get_by_role("button", name="Act on this screen")).to_be_enabled(
            timeout=PATIENCE_MS
        )

    used = link()
    first, second = new_context().new_page(), new_context().new_page()
    first.goto(used)
    is_paired(first)
    first.goto(used)
    is_paired(first)
    expect(first.get_by_role("alert")).to_have_count(0)

    second.goto(used)
    expect(second.get_by_role("alert")).to_be_visible(timeout=PATIENCE_MS)
    expect(second.get_by_role("button", name="Act on this screen")).to_have_count(0)

    second.goto(link())
    is_paired(second)
    expect(first.get_by_text("This headset was disconnected")).to_be_visible(timeout=PATIENCE_MS)
    first.reload()
    expect(first.get_by_role("heading", name="Connect this headset")).to_be_visible(
        timeout=PATIENCE_MS
    )
    is_paired(second)
