"""Browser tests of simultaneous or repeated actions of operators and participants."""

import re
import time
from collections.abc import Callable
from typing import Any

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, Experimenter, Participant
from tests.e2e.test_tablet_offline import EXPERT, FORM, code_for, stored
from tests.faults.figures import note
from tests.features.lab import ok
from tests.features.record.headset.site import Site
from tests.support.browser import PageWatch

TIMES = 50
EVERY_SUBMISSION_AT_ONCE = """(() => {
    const once = window.fetch.bind(window);
    window.receipts = [];
    window.fetch = async (asked, options) => {
        const request = new Request(asked, options);
        if (!request.url.endsWith("/api/tablet/submissions")) return once(request);
        const copies = Array.from({ length: %d }, () => request.clone());
        const answers = await Promise.all(copies.map((copy) => once(copy)));
        window.receipts = await Promise.all(answers.map(async (answer) =>
            [answer.status, (await answer.clone().json()).receipt_id]));
        return answers[0];
    };
})()"""

# Timed by the pages' own clocks: pressing one after the other would not be simultaneous.
TOGETHER_IN_S = 1.5
PRESS_AT = """(at_ms) => {
    const press = () => [...document.querySelectorAll("[role=dialog] button")]
        .find((button) => button.textContent === "Start anyway").click();
    setTimeout(press, at_ms - Date.now());
}"""


def test_a_form_sent_fifty_times_in_parallel_is_stored_once(
    headset_site: Site, page_factory: Callable[..., Page], page_watch: PageWatch
) -> None:
    """A form sent fifty times in parallel by one browser is stored once, with one receipt."""
    page_watch.allow(r"status of 401")
    session_id = headset_site.join()
    headset_site.skip_to(session_id, FORM)
    page = page_factory((1180, 820))
    page.add_init_script(EVERY_SUBMISSION_AT_ONCE % TIMES)
    participant = Participant(page, headset_site.server.url)
    participant.pair(code_for(headset_site, session_id))
    expect(page.locator('[data-name^="q"]').first).to_be_visible(timeout=PATIENCE_MS)
    participant.fill_in(EXPERT)
    page.wait_for_function("() => window.receipts.length > 0", timeout=PATIENCE_MS)
    receipts = page.evaluate("() => window.receipts")
    note(9, f"a browser sends a form {TIMES} times at once", "answered", len(receipts))
    note(9, f"a browser sends a form {TIMES} times at once", "receipts", len(as_set(receipts)))
    forms = stored(headset_site, session_id)
    note(9, f"a browser sends a form {TIMES} times at once", "forms stored", len(forms))
    assert len(receipts) == TIMES
    assert [status for status, _ in as_set(receipts)] == [200]
    assert len(forms) == 1


def as_set(receipts: list[list[Any]]) -> set[tuple[int, str]]:
    """Return the distinct responses, each with its status and receipt."""
    return {(status, receipt) for status, receipt in receipts}


def test_of_two_tablets_with_one_code_one_is_paired(
    headset_site: Site, page_factory: Callable[..., Page], page_watch: PageWatch
) -> None:
    """Of two tablets with the same code only one is paired; a new code moves the session.

    The second tablet shows what to do, and the first one says that it was replaced.
    """
    page_watch.allow(r"status of (401|404|410)")
    session_id, url = headset_site.join(), headset_site.server.url
    headset_site.command(session_id, "start")
    code = code_for(headset_site, session_id)
    pages = [page_factory((1180, 820)) for _ in range(2)]
    for page in pages:
        page.goto(f"{url}/tablet?code={code}", wait_until="commit")
    agree, refused = "I agree to take part", "this code was already used"
    for page in pages:
        held = page.get_by_role("button", name=agree)
        told = page.get_by_text(refused, exact=False)
        expect(held.or_(told).first).to_be_visible(timeout=PATIENCE_MS)
    holding = [page for page in pages if page.get_by_role("button", name=agree).is_visible()]
    note(11, "two tablets, one code", "tablets that hold the session", len(holding))
    assert len(holding) == 1
    (first,) = holding
    (second,) = [page for page in pages if page is not first]
    second.goto(f"{url}/tablet?code={code_for(headset_site, session_id)}")
    expect(second.get_by_role("button", name=agree)).to_be_visible(timeout=PATIENCE_MS)
    expect(first.get_by_text("This tablet was disconnected")).to_be_visible(timeout=PATIENCE_MS)
    note(11, "a new code for another tablet", "dual holders", 0)


def wait_for_any(pages: list[Page], text: str) -> list[Page]:
    """Return the pages that show `text`, once one of them does."""
    until_s = time.monotonic() + PATIENCE_MS / 1000
    while time.monotonic() < until_s:
        saying = [page for page in pages if page.get_by_text(text).count()]
        if saying:
            return saying
        pages[0].wait_for_timeout(50)
    return []


def test_two_operators_press_start_in_two_browsers(
    headset_site: Site, page_factory: Callable[..., Page], page_watch: PageWatch
) -> None:
    """A session started in two browsers simultaneously starts once, and the second one says so."""
    page_watch.allow(r"status of 409")
    session_id = headset_site.join()
    pages = [page_factory((1280, 800)) for _ in range(2)]
    for page in pages:
        desk = Experimenter(page, headset_site.server.url)
        desk.log_in()
        page.goto(f"{headset_site.server.url}/#/sessions/{session_id}")
        desk.press("Start session")
        asked = page.get_by_role("dialog")
        asked.get_by_label("Reason").fill("Only the desk is tried")
    together_ms = 1000 * (time.time() + TOGETHER_IN_S)
    for page in pages:
        page.evaluate(PRESS_AT, together_ms)
    for page in pages:
        expect(page.get_by_text(re.compile(r"^Step 1 of"))).to_be_visible(timeout=PATIENCE_MS)
    events = ok(headset_site.operator.get(f"/api/sessions/{session_id}/events"))
    starts = [one for one in events if one["type"] == "session_started"]
    note(25, "two operators press start in two browsers", "starts on record", len(starts))
    assert len(starts) == 1
    told = len(wait_for_any(pages, "The session was started."))
    note(25, "two operators press start in two browsers", "pages that tell of the other", told)
    assert told == 1
