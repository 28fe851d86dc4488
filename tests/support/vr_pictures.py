"""Take the pictures of docs/headset-page.md and docs/headsets.md in the headset's page.

    python -m tests.support.vr_pictures

A scripted participant takes part in the shipped study on the shipped page; each picture is a frame
of that visit, as both eyes or as one eye see it. Before it, the headset tests itself. The pictures
have 256 colours, which makes them a third of the size.
"""

import re
import tempfile
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import BrowserContext, ViewportSize

from tests.features.record.headset.site import Site, open_site
from tests.protocol.helpers import SHIPPED
from tests.support.browser import launched_browser
from tests.support.page_pictures import COLOURS, DOCS
from tests.support.server import LiveServer
from tests.support.vr_visit import (
    FRAMES_AT_ONCE,
    PATIENCE_MS,
    QUICK,
    Json,
    Visit,
    WornHeadset,
    begun,
    journey_script,
    ok,
)

STUDY = "headset-pictures"
IMAGES = DOCS / "images"
SIZE_PX: ViewportSize = {"width": 1920, "height": 960}
"""Both eyes beside each other."""
BOTH_PX = (960, 480)
LEFT_EYE = (0, 200, 960, 900)
LOW_LEFT_EYE = (0, 260, 960, 960)
"""Of the picture of both eyes: the left one, without what lies far above, and below."""
LEFT_PX = (720, 525)
VERDICTS_PX: ViewportSize = {"width": 900, "height": 1000}
ROAM_S, HAND_S, FOOT_S = 6, 12, 12
INTO_PHASE_FRAMES = 3 * FRAMES_AT_ONCE
DOWN_AT_HANDS = "[0.1, 1.0, -0.6]"
DOWN_AT_FEET = "[journey.person.standsAt[0] - 0.05, 0, journey.person.standsAt[1] - 0.2]"
"""Where the participant looks for a picture of the own body, m."""


def main() -> None:
    """Take part until every picture is taken, and store them."""
    with (
        tempfile.TemporaryDirectory(prefix="reembody-pictures-") as folder,
        LiveServer(Path(folder)) as server,
        launched_browser() as browser,
        open_site(server) as site,
        browser.new_context(viewport=SIZE_PX) as context,
    ):
        ok(site.operator.post("/api/studies", json={"yaml": _study()}))
        script = journey_script(Path(folder))
        _test_itself(site, context, script)
        visit, tablet = begun(
            site.operator, context, script, server.url, STUDY, time_scale=10.0, traits=QUICK
        )
        with tablet:
            _take_part(visit)


def _study() -> str:
    """Return the shipped study with short phases and its first questionnaire in the headset."""
    text = SHIPPED.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
    text = text.replace("duration_s: 120", f"duration_s: {ROAM_S}")
    text = text.replace("duration_s: 60", f"duration_s: {HAND_S}", 1)
    text = text.replace("duration_s: 60", f"duration_s: {FOOT_S}", 1)
    asked = "questionnaire: karas2020"
    text = text.replace(asked, f"{asked}\n        forms: headset", 1)
    return re.sub(r"(preparation_s|freeze_s): 5", r"\1: 0.3", text)


def _test_itself(site: Site, context: BrowserContext, script: Path) -> None:
    """Let a headset test itself: as its wearer sees it, and the page with the verdicts."""
    path = f"/api/studies/{STUDY}/sessions"
    session_id = str(ok(site.operator.post(path, json={"language": "en"}))["id"])
    path = f"/api/sessions/{session_id}/pairings"
    headset = WornHeadset(context, script, site.server.url)
    headset.open(str(ok(site.operator.post(path, json={"device": "headset"}))["code"]))
    page = headset.page
    page.get_by_role("button", name="Test this headset (2 minutes)").click(timeout=PATIENCE_MS)
    headset.until("globalThis.reembodyTest !== undefined && journey.headset.session")
    headset.do("reembodyTest.isRendering = false")
    _until_test(headset, "kind === 'measuring'")
    while not headset.tell("reembodyTest.progress.place?.movement === 'hands'"):
        headset.step(FRAMES_AT_ONCE)
    _save_left(_opened(headset.picture("reembodyTest")), "self-test")
    while headset.tell("reembodyTest.progress.kind") == "measuring":
        headset.step(FRAMES_AT_ONCE)
    _until_test(headset, "kind === 'stored'")
    page.evaluate("() => journey.press('leave')")
    headset.until("journey.headset.session === null")
    # What the browser draws needs real frames.
    headset.do("journey.clock.uninstall()")
    page.set_viewport_size(VERDICTS_PX)
    _save(_opened(page.screenshot()), "self-test-verdicts")
    page.close()


def _until_test(headset: WornHeadset, condition: str) -> None:
    while not headset.tell(f"reembodyTest.progress.{condition}"):
        headset.step(3)
        headset.page.wait_for_timeout(20)


def _take_part(visit: Visit) -> None:
    headset = visit.headset
    visit.perform(until=lambda _: headset.tell("reembody.place") == "calibrating")
    # Both grips held would be a stop.
    headset.do("journey.grip(false)")
    headset.step(2 * INTO_PHASE_FRAMES)
    _store(visit, "calibration")
    visit.perform(until=lambda _: headset.tell("reembody.place") == "stepping_in")
    _store(visit, "stepping-in")
    _enter(visit, "free_roam", None)
    _store(visit, "free-roam")
    _pause(visit)
    _enter(visit, "task", "hand")
    _store(visit, "hand-task")
    _store_looking(visit, "hand-first-person", DOWN_AT_HANDS)
    _question(visit)
    _enter(visit, "task", "foot")
    _store(visit, "foot-task")
    _store_looking(visit, "foot-first-person", DOWN_AT_FEET)


def _enter(visit: Visit, kind: str, limb: str | None) -> None:
    """Go on to a phase, and let the participant act in it for a while."""

    def is_there(view: Json) -> bool:
        current = view["current"]
        if current is None or current["status"] != "running" or not view["phases"]:
            return False
        phase = view["phases"][-1]
        return (phase["kind"], phase["limb"]) == (kind, limb)

    visit.perform(until=is_there)
    visit.draw(INTO_PHASE_FRAMES)


def _pause(visit: Visit) -> None:
    """Pause the phase that runs for a picture of the pause room."""
    visit.command(visit.view(), "pause")
    _until(visit, "reembody.panel.wanted.kind === 'pause'")
    visit.headset.step(FRAMES_AT_ONCE)
    _store_left(visit, "pause")


def _question(visit: Visit) -> None:
    """Answer the first question of the form in the headset, and leave the others."""
    visit.perform(until=lambda _: visit.headset.tell("reembody.panel.wanted.kind") == "form")
    _until(visit, "reembody.panel.targetsM.length > 0")
    for target in ("start", "answer 5"):
        visit.headset.page.evaluate("(target) => journey.press(target)", target)
    _store_left(visit, "form")
    visit.headset.do("journey.aim('right', null)")
    visit.command(visit.view(), "skip", reason="a picture needs one answer")


def _until(visit: Visit, condition: str) -> None:
    while not visit.headset.tell(condition):
        visit.headset.step(5)
        visit.headset.page.wait_for_timeout(20)


def _store(visit: Visit, name: str) -> None:
    """Store what both eyes see."""
    _save(_picture(visit).resize(BOTH_PX, Image.Resampling.LANCZOS), name)


def _store_left(visit: Visit, name: str, part: tuple[int, int, int, int] = LEFT_EYE) -> None:
    """Store what the left eye sees."""
    _save_left(_picture(visit), name, part)


def _store_looking(visit: Visit, name: str, at_m: str) -> None:
    """Store what the left eye sees while the participant looks at a point."""
    visit.headset.do(f"journey.person.lookAt({at_m})")
    visit.draw(FRAMES_AT_ONCE)
    _store_left(visit, name, LOW_LEFT_EYE)
    visit.headset.do("journey.person.lookAt(null)")


def _picture(visit: Visit) -> Image.Image:
    return _opened(visit.headset.picture())


def _opened(picture: bytes) -> Image.Image:
    return Image.open(BytesIO(picture)).convert("RGB")


def _save_left(both: Image.Image, name: str, part: tuple[int, int, int, int] = LEFT_EYE) -> None:
    _save(both.crop(part).resize(LEFT_PX, Image.Resampling.LANCZOS), name)


def _save(picture: Image.Image, name: str) -> None:
    picture.quantize(COLOURS).save(IMAGES / f"headset-{name}.png", optimize=True)


if __name__ == "__main__":
    main()
