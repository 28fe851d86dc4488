"""Measure how soon a form of fourteen statements can be filled in: ours, oTree's, jsPsych's.

A page is ready when every statement it shows at first has a drawn, enabled choice; the page itself
records the time since its navigation began, in the frame where that is first true. Ours shows three
statements at a time (none requires scrolling), the others show all fourteen.
"""

from collections.abc import Iterator
from contextlib import ExitStack
from http.cookies import SimpleCookie
from pathlib import Path

import numpy as np
from playwright.sync_api import Browser, BrowserContext, ViewportSize

from tests.benchmarks.peers.jspsych import VERSION as JSPSYCH_VERSION
from tests.benchmarks.peers.jspsych import served_survey
from tests.benchmarks.peers.otree import VERSION as OTREE_VERSION
from tests.benchmarks.peers.otree import running_otree
from tests.benchmarks.report import Figure
from tests.benchmarks.session_desk.site import ITEMS, signed_in, statements
from tests.support.browser import launched_browser
from tests.support.server import LiveServer

PART = "form"
REPEATS = 7
SIZE = ViewportSize(width=1180, height=820)
SHOWN_AT_FIRST = 3
READY_WITHIN_MS = 20_000
STEPS = [str(step) for step in range(1, 8)]
WHEN_READY = """
window.readyAt = null;
const look = () => {
  const drawn = [...document.querySelectorAll('input[type=radio]:enabled')].filter(
    (one) => (one.closest('label') ?? one.parentElement).getClientRects().length > 0);
  if (new Set(drawn.map((one) => one.name)).size >= EXPECTED) window.readyAt = performance.now();
  else requestAnimationFrame(look);
};
requestAnimationFrame(look);
"""


def figures(folder: Path) -> Iterator[Figure]:
    """Measure each system with an empty browser cache, then with a filled one."""
    folder.mkdir()
    with ExitStack() as stack:
        browser = stack.enter_context(launched_browser())
        server = stack.enter_context(LiveServer(folder / "ours"))
        desk = stack.enter_context(signed_in(server))
        desk.add_forms_study(1)
        otree = stack.enter_context(
            running_otree(folder / "otree", statements(), REPEATS, rounds=1)
        )
        survey = stack.enter_context(served_survey(folder / "jspsych", statements(), STEPS))
        rows: dict[str, list[tuple[float, float]]] = {"ours": [], "oTree": [], "jsPsych": []}
        # Alternately, so that other load on the machine affects all equally.
        for at in range(REPEATS):
            cookie = desk.tablet_at_form()
            tablet = f"{server.url}/tablet/"
            rows["ours"].append(_twice(browser, tablet, SHOWN_AT_FIRST, server.url, cookie))
            rows["oTree"].append(_twice(browser, otree.url + otree.first_page(at), ITEMS))
            rows["jsPsych"].append(_twice(browser, survey, ITEMS))
    for column, how in enumerate(("an empty browser", "a browser that knows the page")):
        median = {name: float(np.median([row[column] for row in of])) for name, of in rows.items()}
        what = f"ready to fill in, {how}, p50 of {REPEATS}"
        peers = (("oTree", OTREE_VERSION), ("jsPsych", JSPSYCH_VERSION))
        for name, version in peers:
            yield Figure(PART, what, median["ours"], "ms", f"{name} {version}", median[name])


def _twice(
    browser: Browser, url: str, expected: int, origin: str = "", cookie: str = ""
) -> tuple[float, float]:
    """Return the time in ms until the page is ready, without and with a filled browser cache."""
    context = browser.new_context(viewport=SIZE, locale="en-US")
    try:
        context.add_init_script(WHEN_READY.replace("EXPECTED", str(expected)))
        for name, morsel in SimpleCookie(cookie).items():
            context.add_cookies([{"name": name, "value": morsel.value, "url": origin}])
        return _once(context, url), _once(context, url)
    finally:
        context.close()


def _once(context: BrowserContext, url: str) -> float:
    page = context.new_page()
    page.goto(url, wait_until="commit")
    page.wait_for_function("() => window.readyAt !== null", timeout=READY_WITHIN_MS)
    took_ms = float(page.evaluate("window.readyAt"))
    page.close()
    return took_ms
