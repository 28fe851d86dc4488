"""Browser test of a questionnaire that the experimenter reads aloud and answers in the cockpit."""

from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.e2e.people import PATIENCE_MS, PICTURE_HIDDEN, Experimenter
from tests.features.lab import ok
from tests.features.record.headset.site import Site
from tests.protocol.helpers import STUDY as FILE

STUDY = "read-aloud"


def study_read_aloud() -> str:
    """Return the shipped study, which begins with its questionnaire read aloud."""
    text = FILE.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
    first = "{step: form, instrument: karas2020, forms: oral}"
    return text.replace("{step: consent, text: consent}", first, 1)


def test_the_questions_that_are_read_aloud_stand_in_the_cockpit(
    headset_site: Site,
    page_factory: Callable[..., Page],
    axe: Callable[[Page], list[str]],
    screenshot: Callable[[Page, str], object],
) -> None:
    """The step shows the questions at once; what the operator chooses is stored as the answers."""
    operator = headset_site.operator
    ok(operator.post("/api/studies", json={"yaml": study_read_aloud()}))
    session_id = str(ok(operator.post(f"/api/studies/{STUDY}/sessions", json={}))["id"])
    headset_site.command(session_id, "start")
    page = page_factory((1180, 820), "dark")
    page.add_init_script(PICTURE_HIDDEN)
    Experimenter(page, headset_site.server.url).log_in()
    page.goto(f"{headset_site.server.url}/#/sessions/{session_id}")
    card = page.locator('[data-tour="step"]')
    expect(card.get_by_text("Read the questions aloud")).to_be_visible(timeout=PATIENCE_MS)
    form = ok(operator.get(f"/api/sessions/{session_id}/administration"))
    items = {item["key"]: item for item in form["instrument"]["items"]}
    first = items[form["item_order"][0]]["text"]["en"]
    expect(card.get_by_text(first)).to_be_visible(timeout=PATIENCE_MS)
    screenshot(page, "read-aloud")
    assert axe(page) == []
    chosen: dict[str, int] = {}
    while True:
        for question in card.locator("[data-name]").all():
            key = question.get_attribute("data-name") or ""
            options = question.locator('input[type="radio"]')
            if options.count() > 0:
                chosen[key] = 1 + len(chosen) % 7
                question.locator(f'input[value="{chosen[key]}"]').check(force=True)
        send = card.get_by_role("button", name="Save answers")
        if send.is_visible():
            send.click()
            break
        card.get_by_role("button", name="Next").click()
    expect(card.get_by_text("Read the questions aloud")).to_have_count(0, timeout=PATIENCE_MS)
    (stored,) = ok(operator.get(f"/api/sessions/{session_id}/answers"))
    assert stored["mode"] == "operator"
    assert {key: stored["answers"][key] for key in chosen} == chosen
    assert len(chosen) == 14
