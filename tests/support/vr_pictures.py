"""Take the pictures of docs/headset-page.md from one visit in the headset's page.

    python -m tests.support.vr_pictures

A scripted participant takes part in the shipped study on the shipped page; each picture is a frame
of that visit as both eyes see it. They have 256 colours, which makes them a third of the size.
"""

import re
import tempfile
from io import BytesIO
from pathlib import Path

from PIL import Image
from playwright.sync_api import ViewportSize

from tests.features.record.headset.site import open_site
from tests.protocol.helpers import SHIPPED
from tests.support.browser import launched_browser
from tests.support.page_pictures import COLOURS, DOCS
from tests.support.server import LiveServer
from tests.support.vr_visit import FRAMES_AT_ONCE, Json, Visit, begun, journey_script, ok

STUDY = "headset-pictures"
IMAGES = DOCS / "images"
SIZE_PX: ViewportSize = {"width": 960, "height": 480}
"""Both eyes beside each other."""
ROAM_S, HAND_S = 3, 8
INTO_PHASE_FRAMES = 3 * FRAMES_AT_ONCE


def main() -> None:
    """Take part until every picture is taken, and store them."""
    with (
        tempfile.TemporaryDirectory(prefix="reembody-pictures-") as folder,
        LiveServer(Path(folder)) as server,
        launched_browser() as browser,
        open_site(server) as site,
        browser.new_context(viewport=SIZE_PX) as context,
    ):
        text = SHIPPED.replace("key: reembodiment-latency", f"key: {STUDY}", 1)
        text = text.replace("duration_s: 120", f"duration_s: {ROAM_S}")
        text = text.replace("duration_s: 60", f"duration_s: {HAND_S}", 1)
        text = re.sub(r"(preparation_s|freeze_s): 5", r"\1: 0.3", text)
        ok(site.operator.post("/api/studies", json={"yaml": text}))
        script = journey_script(Path(folder))
        visit, tablet = begun(site.operator, context, script, server.url, STUDY, time_scale=10.0)
        with tablet:
            _take(visit, "free-roam", "free_roam", None)
            _take(visit, "hand-task", "task", "hand")


def _take(visit: Visit, name: str, kind: str, limb: str | None) -> None:
    """Go on to a phase, let the participant act in it, and store what the eyes see."""

    def is_there(view: Json) -> bool:
        current = view["current"]
        if current is None or current["status"] != "running" or not view["phases"]:
            return False
        phase = view["phases"][-1]
        return (phase["kind"], phase["limb"]) == (kind, limb)

    visit.perform(until=is_there)
    visit.draw(INTO_PHASE_FRAMES)
    picture = Image.open(BytesIO(visit.headset.picture())).convert("RGB")
    picture.quantize(COLOURS).save(IMAGES / f"headset-{name}.png", optimize=True)


if __name__ == "__main__":
    main()
