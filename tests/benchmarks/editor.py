"""Measure the try-out of the avatar editor: how fast its physics is, and what it costs the page.

`simulation` runs the physics of the page in Node, for the shipped configuration with its body of 52
parts, alone and side by side with another: simulated time by processor time, while a joint swings,
a shin is pushed and boxes fall. `push` tells how far a pushed shin gives way, and how long it takes
to return within 2 degrees, for the first shipped configuration with its left leg raised. `page` is
the scripting of the page's thread for each picture in Chromium (`ScriptDuration`), where calls that
draw do nothing: they would wait for a graphics card, which this machine imitates in software. What
a picture takes with them is reported beside it.
"""

import json
import tempfile
from pathlib import Path
from typing import Any

from playwright.sync_api import CDPSession, Page, expect

from app.adapters.humanoids import read_humanoid
from app.features.movement.avatar.service import shipped_configurations
from app.protocol.avatar import file_of
from app.science.avatar.body import figure_of
from app.science.avatar.mjcf import (
    AvatarModel,
    LooseBox,
    Scene,
    avatar_model,
    default_configuration,
)
from tests.benchmarks.report import Figure, Report
from tests.benchmarks.session_desk.site import signed_in
from tests.support.bodies_page import BODY
from tests.support.browser import launched_browser
from tests.support.node import install_packages, run_node
from tests.support.server import LiveServer
from tests.support.tryout_page import PATIENCE_MS, figure, opened_tryout

Json = dict[str, Any]
PARTS = ("simulation", "push", "page")
SECONDS = 6.0
FACTOR_LIMIT = 3.0
SCRIPT_LIMIT_MS = 16.0
SIMULATED_A_SECOND = 5.0
FRONTEND = Path(__file__).resolve().parents[2] / "frontend"
BOX = LooseBox("box", (0.0, 4.0, 0.0), (0.1, 0.1, 0.1), 2.0)
STATURE_M = 1.75
COUNTED = """
window.picturesAsked = 0;
requestAnimationFrame(function count() { window.picturesAsked++; requestAnimationFrame(count); });
"""
UNDRAWN = """
for (const name of ['drawElements', 'drawArrays', 'drawElementsInstanced', 'drawArraysInstanced'])
  WebGL2RenderingContext.prototype[name] = () => {};
"""


def measure(parts: frozenset[str], duration_s: float = SECONDS) -> Report:
    """Measure; the page for `duration_s` each, the simulation for five times as much of its own."""
    report = Report("editor")
    with tempfile.TemporaryDirectory(prefix="reembody-bench-") as name:
        folder = Path(name)
        if parts & {"simulation", "push"}:
            _simulate(report, parts, folder, SIMULATED_A_SECOND * duration_s)
        if "page" in parts:
            _watch_page(report, folder, duration_s)
    return report


def _simulate(report: Report, parts: frozenset[str], folder: Path, simulated_s: float) -> None:
    configuration = shipped_configurations()[-1]
    figure = figure_of(read_humanoid(BODY.read_bytes()).humanoid)
    scene = Scene(loose=(BOX,))
    model = avatar_model(configuration, STATURE_M, figure=figure, scene=scene)
    body = folder / "body.json"
    plain = avatar_model(default_configuration(), STATURE_M, scene=scene)
    body.write_text(json.dumps({"body": _to_try(model), "plain": _to_try(plain)}))
    install_packages(FRONTEND)
    script = Path(__file__).with_name("editor_physics.mjs")
    arguments = (str(script), str(FRONTEND), str(body), str(simulated_s))
    found = json.loads(run_node(*arguments, cwd=FRONTEND))
    if "simulation" in parts:
        count = len(model.body.parts)
        for key, words in (("alone", f"{count} parts"), ("side_by_side", f"2 x {count} parts")):
            one = found[key]
            factor = one["simulated_s"] / one["cpu_s"]
            report.add(
                Figure(
                    "simulation", f"{words}, simulated time by processor time",
                    factor, "times", "at least", FACTOR_LIMIT,
                ),
                Figure(
                    "simulation", f"{words}, failures and resets",
                    one["failures"] + one["not_finite"], "", "at most", 0.0,
                ),
            )  # fmt: skip
            report.beside[f"real_time_factor_{key}"] = factor
    if "push" in parts:
        for push in found["pushes"]:
            words = f"shin pushed by {push['force_n']} N for .2 s"
            report.add(
                Figure("push", f"{words}, gives way by", push["greatest_deg"], "deg"),
                Figure("push", f"{words}, back within 2 deg after", push["returned_s"], "s"),
            )


def _to_try(model: AvatarModel) -> Json:
    tree = file_of(model.configuration).model_dump(mode="json", exclude_none=True)
    return {"mjcf": model.mjcf, "configuration": tree}


def _watch_page(report: Report, folder: Path, duration_s: float) -> None:
    with (
        LiveServer(folder) as server,
        signed_in(server) as desk,
        launched_browser() as browser,
    ):
        cookies: Any = [
            {"name": one.name, "value": one.value or "", "url": server.url}
            for one in desk.client.cookies.jar
        ]
        for is_drawn in (False, True):
            context = browser.new_context(viewport={"width": 1280, "height": 800}, locale="en-US")
            context.add_cookies(cookies)
            script = COUNTED if is_drawn else UNDRAWN + COUNTED
            page = opened_tryout(context, server.url, folder / f"page{is_drawn:d}", script)
            session = context.new_cdp_session(page)
            # Processor time of the page's thread, not the time of day: others may be working too.
            session.send("Performance.enable", {"timeDomain": "threadTicks"})
            page.get_by_text("Sine", exact=True).click()
            for words in ("alone", "side by side"):
                if words != "alone":
                    _add_version(page)
                scripting, task, rate = _costs(page, session, duration_s)
                if is_drawn:
                    drawn = f"{words}, with software graphics"
                    report.add(
                        Figure("page", f"{drawn}, all work of the page's thread", task, "ms"),
                        Figure("page", f"{drawn}, pictures a second", rate, "1/s"),
                    )
                    continue
                name = f"{words}, scripting a picture"
                report.add(Figure("page", name, scripting, "ms", "at most", SCRIPT_LIMIT_MS))
                report.beside[f"script_ms_{words.replace(' ', '_')}"] = scripting
            context.close()


def _add_version(page: Page) -> None:
    page.get_by_role("combobox", name="Side by side with").click(timeout=PATIENCE_MS)
    page.get_by_role("option").first.click(timeout=PATIENCE_MS)
    beside = figure(page, "whole").locator("xpath=following-sibling::td")
    expect(beside).to_contain_text("°", timeout=PATIENCE_MS)


def _costs(page: Page, session: CDPSession, duration_s: float) -> tuple[float, float, float]:
    """Return ms of scripting and of all the thread's work a picture, and pictures a second."""
    # Until curves of the whole window are drawn and shaders are compiled.
    page.wait_for_timeout(5000)
    before = _counted(page, session)
    page.wait_for_timeout(1000.0 * duration_s)
    after = _counted(page, session)
    pictures = after[2] - before[2]
    return (
        1000.0 * (after[0] - before[0]) / pictures,
        1000.0 * (after[1] - before[1]) / pictures,
        pictures / duration_s,
    )


def _counted(page: Page, session: CDPSession) -> tuple[float, float, int]:
    """Return the seconds of scripting, those of all work, and the pictures so far."""
    metrics = {
        one["name"]: float(one["value"])
        for one in session.send("Performance.getMetrics")["metrics"]
    }
    pictures = int(page.evaluate("window.picturesAsked"))
    return metrics["ScriptDuration"], metrics["TaskDuration"], pictures
