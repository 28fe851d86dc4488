"""Browser test of an offline tablet whose browser is killed: nothing is lost or sent twice."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, BrowserContext, Page, Response, expect

from tests.e2e.killing import kept_profile, kill_browser
from tests.e2e.people import PATIENCE_MS
from tests.faults.figures import note
from tests.features.lab import Json, ok
from tests.features.record.headset.site import Site
from tests.support.browser import accessibility_violations

FORM = "block1.hand.karas2020"
KEPT = """async () => {
    const open = (name) => new Promise((done, failed) => {
        const asked = indexedDB.open(name);
        asked.onsuccess = () => done(asked.result);
        asked.onerror = () => failed(asked.error);
    });
    const database = await open("reembody-tablet");
    const all = (store) => new Promise((done) => {
        const asked = database.transaction(store).objectStore(store).getAll();
        asked.onsuccess = () => done(asked.result);
    });
    const found = { kept: await all("kept"), screen: await all("screen") };
    database.close();
    return found;
}"""
ARE_KEPT = f"""async (answers) => {{
    const {{ kept }} = await ({KEPT})();
    return Object.keys(kept[0]?.draft.data ?? {{}}).length >= answers;
}}"""
NAMES = """async () => (await Promise.all(
    (await caches.keys()).map(async (name) => (await (await caches.open(name)).keys())
        .map(({ url }) => new URL(url).pathname)))).flat()"""
CACHED = f"async () => (await ({NAMES})()).includes('/tablet')"
FAULT = "tablet offline for 10 min, killed, back"
SENT = "/api/tablet/submissions"
EXPERT = {f"q{number}": str(1 + number % 7) for number in range(1, 15)}


class Visit:
    """One run of the tablet's browser, from opening to closing."""

    def __init__(self, context: BrowserContext, url: str) -> None:
        self.page: Page = context.new_page()
        self.page.set_viewport_size({"width": 1180, "height": 820})
        self._context, self._url = context, url

    def open(self, *, network: bool, query: str = "") -> None:
        """Open the page by its URL, as a participant who picks up the tablet does."""
        self._context.set_offline(not network)
        self.page.goto(f"{self._url}/tablet{query}")

    def cut_off(self) -> None:
        """Disconnect the network."""
        self._context.set_offline(True)

    def reconnect(self) -> None:
        """Reconnect the network."""
        self._context.set_offline(False)

    def choose(self, items: int | None = None) -> int:
        """Answer the first items of the page, or all of them; return how many there were."""
        count = 0
        for question in self.page.locator("[data-name]").all()[:items]:
            value = EXPERT.get(question.get_attribute("data-name") or "")
            if value is not None:
                question.locator(f'input[value="{value}"]').first.check(force=True)
                count += 1
        return count

    def keeps(self, answers: int) -> None:
        """Wait until so many answers are on the disk, where a killed browser leaves them."""
        self.page.wait_for_function(ARE_KEPT, arg=answers, polling=200, timeout=PATIENCE_MS)

    def press(self, name: str) -> None:
        """Press the button with this name."""
        self.page.get_by_role("button", name=name).click()

    def sees_form(self) -> None:
        """Wait until a question is shown."""
        expect(self.page.locator('[data-name^="q"]').first).to_be_visible(timeout=PATIENCE_MS)

    def sees(self, heading: str) -> None:
        """Wait for the screen that has this heading."""
        title = self.page.get_by_role("heading", name=heading)
        expect(title).to_be_visible(timeout=PATIENCE_MS)

    def kept(self) -> Any:
        """Return the forms and the last screen that are stored in IndexedDB."""
        return self.page.evaluate(KEPT)


def code_for(site: Site, session_id: str) -> str:
    """Return a pairing code for the session's tablet."""
    path = f"/api/sessions/{session_id}/pairings"
    return str(ok(site.operator.post(path, json={"device": "tablet"}))["code"])


def entered(kept: Any) -> Json:
    """Return the answers of the only stored form, as text."""
    (form,) = kept["kept"]
    return {item: str(value) for item, value in form["draft"]["data"].items()}


def noted_status(response: Response, arrived: list[int]) -> None:
    """Record the status of a response to a submission."""
    if SENT in response.url:
        arrived.append(response.status)


def test_ten_minutes_offline_and_a_killed_browser_lose_nothing(
    browser: Browser, headset_site: Site, tmp_path: Path, screenshot: Callable[[Page, str], object]
) -> None:
    """Answers survive ten minutes offline and two kills of the browser, and are sent once."""
    site, url = headset_site, headset_site.server.url
    session_id = site.join()
    site.skip_to(session_id, FORM)

    @contextmanager
    def life() -> Iterator[Visit]:
        with kept_profile(browser, tmp_path) as context:
            yield Visit(context, url)

    with life() as visit:
        visit.open(network=True, query=f"?code={code_for(site, session_id)}")
        visit.sees_form()
        visit.page.wait_for_function(CACHED, timeout=PATIENCE_MS)
    with life() as visit:
        visit.open(network=True)
        visit.sees_form()
        visit.page.wait_for_function(CACHED, timeout=PATIENCE_MS)
        visit.cut_off()
        answered = visit.choose()
        visit.press("Next")
        visit.keeps(answered + visit.choose(1))
        before = entered(visit.kept())
        kill_browser(tmp_path)
    with life() as visit:
        visit.page.clock.install()
        visit.open(network=False)
        visit.sees_form()
        assert len(before) >= 3
        lost = {item for item, value in before.items() if entered(visit.kept()).get(item) != value}
        expect(visit.page.get_by_text("Page 2 of 5")).to_be_visible()
        expect(visit.page.locator("[data-name] input:checked")).to_have_count(1)
        assert accessibility_violations(visit.page) == []
        screenshot(visit.page, "tablet-offline-form")
        while not visit.page.get_by_role("button", name="Send answers").is_visible():
            visit.choose()
            visit.press("Next")
        visit.choose()
        visit.press("Send answers")
        visit.sees("Your answers are safe")
        visit.page.clock.fast_forward("10:00")
        visit.sees("Your answers are safe")
        kill_browser(tmp_path)
    assert stored(site, session_id) == []
    with life() as visit:
        arrived: list[int] = []
        visit.page.on("response", lambda one: noted_status(one, arrived))
        visit.open(network=False)
        visit.sees("Your answers are safe")
        screenshot(visit.page, "tablet-offline-sent")
        visit.reconnect()
        visit.sees("Foot task")
        assert visit.kept()["kept"] == []
        assert visit.kept()["screen"][0]["administration"] is None
        assert "/api/" not in str(visit.page.evaluate(NAMES))
    forms = stored(site, session_id)
    answers = {item: value for form in forms for item, value in form["answers"].items()}
    told = {item: f"{value:g}" for item, value in answers.items() if value is not None}
    lost |= {item for item, value in EXPERT.items() if told.get(item) != value}
    note(7, FAULT, "answers lost", len(lost))
    note(7, FAULT, "forms stored beside the one", len(forms) - 1)
    note(7, FAULT, "times it was sent", len(arrived))
    note(8, "tablet's browser killed while offline", "fields lost", len(lost))
    assert (lost, len(forms), arrived) == (set(), 1, [200])


def stored(site: Site, session_id: str) -> list[Json]:
    """Return every form that is stored on the server."""
    forms: list[Json] = ok(site.operator.get(f"/api/sessions/{session_id}/answers"))
    return forms
