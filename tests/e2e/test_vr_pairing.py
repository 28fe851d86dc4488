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


FOREIGN = "is nobody's pairing"
KEY = "reembody.vr.pairing"


def test_a_token_that_is_not_this_headsets_leads_back_to_pairing(
    headset_site: Site, new_context: ContextFactory, page_watch: PageWatch
) -> None:
    """A token of an operator, of a tablet, of a headset that was replaced, or none at all.

    Each is refused without a word to the session, and forgotten; a token of another session opens
    that one, and a session that has ended says so.
    """
    page_watch.allow(r"status of 4\d\d|WebSocket connection to .* failed")
    site, url = headset_site, headset_site.server.url
    session_id, other_id = site.join(kind="test"), site.join(kind="test")
    replaced = site.token(session_id)
    token = site.token(session_id)
    codes = f"/api/sessions/{session_id}/pairings"
    code = ok(site.operator.post(codes, json={"device": "tablet"}))["code"]
    with site.server.client() as tablet:
        ok(tablet.post("/api/devices/pair", json={"code": code}))
        (tablets,) = tablet.cookies.values()
    operators = site.operator.cookies["reembody_login"]
    page = new_context().new_page()
    page.goto(f"{url}/vr")

    def open_with(held: str) -> None:
        pairing = {"sessionId": session_id, "token": held}
        page.evaluate(f"(one) => localStorage.setItem('{KEY}', JSON.stringify(one))", pairing)
        page.reload()

    for held in (operators, tablets, replaced, "", FOREIGN, "x" * 500):
        open_with(held)
        expect(page.get_by_text("This headset was disconnected")).to_be_visible()
        expect(page.get_by_role("heading", name="Connect this headset")).to_be_visible()
        assert page.evaluate(f"localStorage.getItem('{KEY}')") is None, held
    headsets = [one for one in site.view(session_id)["devices"] if one["kind"] == "headset"]
    assert [one["connected"] for one in headsets] == [False]

    act = page.get_by_role("button", name="Act on this screen")
    open_with(site.token(other_id))
    expect(act).to_be_enabled()
    open_with(token)
    expect(act).to_be_enabled()
    site.command(session_id, "start", reason="in this test")
    site.command(session_id, "abort", reason="seen enough")
    expect(page.get_by_role("heading", name="The session has ended")).to_be_visible()
    page.reload()
    expect(page.get_by_role("heading", name="The session has ended")).to_be_visible()
