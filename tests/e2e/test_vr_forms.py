"""Browser test of forms that are filled in inside the headset, by ray and by pinch."""

import json
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import BrowserContext, Request

from tests.features.record.headset.site import Site
from tests.protocol.helpers import STUDY as FILE
from tests.support.browser import ContextFactory
from tests.support.vr_visit import WornHeadset, journey_script, ok

STUDY = "headset-forms"
OPEN_ITEM = "problems"
RELOADED_AFTER = 7
SMALL_ROOM_M = [[-0.6, -0.6], [0.6, -0.6], [0.6, 0.6], [-0.6, 0.6]]
TOLERANCE_S = 0.02
"""A frame, and rounding; after a reload also the frames in which the test saw that it was there."""
RELOAD_S = 0.1


def study_with_a_form_in_the_headset() -> str:
    """Return the shipped study, which begins with its questionnaire inside the headset."""
    text = FILE.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
    first = "{step: form, instrument: karas2020, forms: headset}"
    return text.replace("{step: consent, text: consent}", first, 1)


@pytest.fixture
def visit_script(tmp_path: Path) -> Path:
    """Provide the emulated headset and its wearer as one script."""
    return journey_script(tmp_path)


class FormInHeadset:
    """Somebody in the headset who reads the panel and presses what is on it."""

    def __init__(self, context: BrowserContext, script: Path, url: str, code: str) -> None:
        self.sent: list[dict[str, Any]] = []
        context.on("request", self._note)
        self.headset = WornHeadset(context, script, url)
        self.headset.open(code)

    def _note(self, request: Request) -> None:
        if request.url.endswith("/api/vr/submissions"):
            self.sent.append(json.loads(request.post_data or "{}"))

    def enter(self, button: str, *, has_hands: bool, bounds_m: object = None) -> None:
        """Enter VR and wait for the form; a guarded space that is too small is accepted first."""
        if bounds_m is not None:
            self.headset.do(f"journey.headset.setBounds({json.dumps(bounds_m)})")
        self.headset.enter(button)
        self.headset.do("reembody.isRendering = false")
        self.headset.do(f"journey.useHands({json.dumps(has_hands)})")
        if bounds_m is not None:
            self.until("reembody.panel.wanted.kind === 'boundary'")
            assert self.screen()["key"] == "boundary small"
            self.press("go on")
        self.until("reembody.panel.wanted.kind === 'form' && reembody.panel.targetsM.length > 0")

    def until(self, condition: str) -> None:
        """Draw frames until a condition of the page is true."""
        for _ in range(100):
            self.headset.step(5)
            if self.headset.tell(condition):
                return
            self.headset.page.wait_for_timeout(20)
        raise AssertionError(f"never: {condition}; {self.headset.tell('reembody.panel')}")

    def screen(self) -> dict[str, Any]:
        """Return what the panel shows."""
        screen: dict[str, Any] = self.headset.tell("reembody.panel.screen")
        return screen

    def press(self, target: str) -> float:
        """Point at a target and press it; return the time of the press, s."""
        return float(self.headset.page.evaluate("(target) => journey.press(target)", target))


@pytest.mark.parametrize(
    ("language", "has_hands", "enter", "eighth"),
    [
        ("en", False, "Enter VR", "Question 8 of 15"),
        ("de", True, "VR starten", "Frage 8 von 15"),
    ],
    ids=["ray-en", "pinch-de"],
)
def test_a_questionnaire_is_answered_inside_the_headset(
    headset_site: Site,
    new_context: ContextFactory,
    visit_script: Path,
    *,
    language: str,
    has_hands: bool,
    enter: str,
    eighth: str,
) -> None:
    """What was pressed is what is stored, once, also through a reload in the middle."""
    operator = headset_site.operator
    if operator.get(f"/api/studies/{STUDY}").status_code == 404:
        ok(operator.post("/api/studies", json={"yaml": study_with_a_form_in_the_headset()}))
    path = f"/api/studies/{STUDY}/sessions"
    session_id = str(ok(operator.post(path, json={"language": language}))["id"])
    code = ok(operator.post(f"/api/sessions/{session_id}/pairings", json={"device": "headset"}))
    headset_site.command(session_id, "start")
    form = FormInHeadset(new_context(), visit_script, headset_site.server.url, str(code["code"]))
    form.enter(enter, has_hands=has_hands, bounds_m=SMALL_ROOM_M)
    shown_s = form.press("start")
    chosen: dict[str, int | None] = {}
    took_s: dict[str, float] = {}
    reloaded = ""
    for number in range(15):
        if number == RELOADED_AFTER:
            form.headset.page.reload()
            form.enter(enter, has_hands=has_hands)
            assert form.screen()["progress"]["text"] == eighth
            shown_s = form.headset.step(1)
        item = form.screen()["key"].split()[-1]
        value = "spoken" if item == OPEN_ITEM else str(1 + (3 * number + len(language)) % 7)
        took_s[item] = form.press(f"answer {value}") - shown_s
        if number == RELOADED_AFTER:
            reloaded = item
        chosen[item] = None if item == OPEN_ITEM else int(value)
        shown_s = form.press("next")
    form.press("more")
    form.press("more")
    form.press("submit")
    form.until("reembody.panel.wanted.kind !== 'form'")

    (stored,) = ok(operator.get(f"/api/sessions/{session_id}/answers"))
    assert stored["mode"] == "headset"
    assert stored["answers"] == chosen
    assert len(chosen) == 15
    (sent,) = form.sent
    for item, seconds in took_s.items():
        response_s = sent["item_traces"][item]["response_s"]
        late_s = RELOAD_S if item == reloaded else 0.0
        assert abs(response_s - seconds) < TOLERANCE_S + late_s, (item, response_s, seconds)
    assert sent["language"] == language
    form.until("reembody.state.panel.called")
    codes = [alarm["code"] for alarm in headset_site.view(session_id)["alarms"]]
    assert "help_asked" in codes, "somebody comes to write down what was said aloud"
