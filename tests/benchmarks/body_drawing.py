"""Measure what drawing a body with skin costs a page: scripting a frame, beside the stick figure.

A walk plays on an avatar in headless Chromium, drawn by turns as capsules and as the shipped body,
which has up to 12,000 triangles. Scripting is the processor time that Chromium counts for the
page's scripts (`ScriptDuration`), everything included that both do alike. Calls that draw do
nothing: they would wait for a graphics card, which this machine imitates in software.
"""

import tempfile
from pathlib import Path
from statistics import median
from typing import Any

from playwright.sync_api import CDPSession, Page

from tests.benchmarks.report import Figure, Report
from tests.benchmarks.session_desk.site import Desk, signed_in
from tests.features.movement.captures.files import walk_bvh
from tests.support.browser import launched_browser
from tests.support.server import LiveServer

PARTS = ("scripting",)
ROUNDS, SECONDS = 9, 3.0
LIMIT_MS = 0.5
FRAMES = 150
PATIENCE_MS = 60_000
BODY = "neutral"
UNTIMED = """
for (const name of ['drawElements', 'drawArrays', 'drawElementsInstanced', 'drawArraysInstanced'])
  WebGL2RenderingContext.prototype[name] = () => {};
localStorage.setItem('reembody.console.language', 'en');
window.framesDrawn = 0;
requestAnimationFrame(function count() { window.framesDrawn++; requestAnimationFrame(count); });
"""


def measure(parts: frozenset[str], duration_s: float = SECONDS, runs: int = ROUNDS) -> Report:
    """Measure `runs` rounds of both, each of them for `duration_s`."""
    report = Report("body_drawing")
    with (
        tempfile.TemporaryDirectory(prefix="reembody-bench-") as folder,
        LiveServer(Path(folder)) as server,
        signed_in(server) as desk,
        launched_browser() as browser,
    ):
        context = browser.new_context(viewport={"width": 1280, "height": 900})
        cookies = desk.client.cookies.jar
        context.add_cookies(
            [{"name": one.name, "value": one.value or "", "url": server.url} for one in cookies]
        )
        page = context.new_page()
        page.add_init_script(UNTIMED)
        triangles = _open_walk(page, desk)
        session = context.new_cdp_session(page)
        # Processor time of the page's thread, not the time of day: others may be working too.
        session.send("Performance.enable", {"timeDomain": "threadTicks"})
        rounds = [
            {look: _script_ms(page, session, look, duration_s) for look in ("Stick figure", BODY)}
            for _ in range(runs)
        ]
    capsules = median(one["Stick figure"] for one in rounds)
    more = median(one[BODY] - one["Stick figure"] for one in rounds)
    name = f"of {runs} rounds, a frame"
    report.add(
        Figure("scripting", f"capsules, p50 {name}", capsules, "ms"),
        Figure("scripting", f"body of {triangles} triangles, p50 {name}", capsules + more, "ms"),
        Figure("scripting", "body, more than the capsules", more, "ms", "limit", LIMIT_MS),
    )
    return report


def _open_walk(page: Page, desk: Desk) -> int:
    """Play a walk on an avatar; return how many triangles its body has."""
    bodies: list[dict[str, Any]] = desk.client.get("/api/humanoids").json()["humanoids"]
    triangles = next(int(one["triangles"]) for one in bodies if one["name"] == BODY)
    capture = desk.client.post(
        "/api/captures", params={"name": "walk.bvh"}, content=walk_bvh(FRAMES), timeout=60.0
    ).json()
    page.goto(f"{desk.server.url}/#/captures/{capture['id']}")
    page.get_by_text("On avatar").click(timeout=PATIENCE_MS)
    page.get_by_label("Show source").uncheck(timeout=PATIENCE_MS)
    page.get_by_label("Loop").check(timeout=PATIENCE_MS)
    page.get_by_role("button", name="Play").click(timeout=PATIENCE_MS)
    return triangles


def _script_ms(page: Page, session: CDPSession, look: str, duration_s: float) -> float:
    """Return the milliseconds of scripting a frame while the walk is drawn in one way."""
    page.get_by_role("combobox", name="Drawn as").click(timeout=PATIENCE_MS)
    page.get_by_role("option", name=look).click(timeout=PATIENCE_MS)
    drawn = "skin" if look == BODY else "skeleton"
    page.wait_for_selector(f"[data-drawn={drawn}]", timeout=PATIENCE_MS)
    # Until its shaders are compiled.
    page.wait_for_timeout(1500)
    before = _counted(page, session)
    page.wait_for_timeout(1000.0 * duration_s)
    after = _counted(page, session)
    return 1000.0 * (after[0] - before[0]) / (after[1] - before[1])


def _counted(page: Page, session: CDPSession) -> tuple[float, int]:
    """Return the seconds of scripting and the frames so far."""
    metrics = session.send("Performance.getMetrics")["metrics"]
    seconds = next(one["value"] for one in metrics if one["name"] == "ScriptDuration")
    return float(seconds), int(page.evaluate("window.framesDrawn"))
