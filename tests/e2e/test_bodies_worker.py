"""Browser test of the worker that computes the bodies, under the policies of the server."""

from pathlib import Path
from typing import Any

from app.protocol.avatar import file_of
from app.science.avatar.mjcf import default_configuration
from tests.support.browser import ContextFactory, PageWatch
from tests.support.bundle import bundled
from tests.support.server import LiveServer

MODEL = Path(__file__).parents[1] / "vectors" / "avatar" / "body.xml"
FRAMES = 45
# Not in the call itself: what a debugger evaluates may make functions from text.
EVALUATE_LATER = """() => new Promise((resolve) => setTimeout(() => {
    try { resolve(new Function("return 'ran'")()); } catch (error) { resolve(error.name); }
}))"""
WATCH = """() => {
    window.violations = [];
    document.addEventListener("securitypolicyviolation",
        (event) => window.violations.push(`${event.violatedDirective} ${event.blockedURI}`));
}"""


def avatar() -> dict[str, Any]:
    """Return the answer of `POST /api/vr/avatar`, as far as the bodies read it."""
    return {
        "stature_m": 1.75,
        "mjcf": MODEL.read_text(),
        "configuration": file_of(default_configuration()).model_dump(mode="json"),
        "standing_hips_m": 0.95375,
    }


def test_bodies_run_in_a_worker_while_the_page_stays_strict(
    running_server: LiveServer,
    new_context: ContextFactory,
    page_watch: PageWatch,
    tmp_path: Path,
) -> None:
    """In the headset's isolated page a worker simulates, and the page runs no text as code."""
    bundle = bundled("vr/bodies/testing/page.ts", tmp_path)
    page = bundle.open(new_context(), running_server.url, "/vr")
    page.evaluate(WATCH)
    measured = page.evaluate(
        "([answer, frames]) => bodiesBench.frames(answer, 'worker', frames)", [avatar(), FRAMES]
    )
    assert measured["isIsolated"]
    assert len(measured["times"]["ik"]) == FRAMES - 1
    assert abs(measured["addedS"] - 1 / 90) < 1e-9
    assert measured["lastPose"][1] > 0.9
    assert page.evaluate("() => violations") == []
    page_watch.allow("unsafe-eval")
    assert page.evaluate(EVALUATE_LATER) == "EvalError"
