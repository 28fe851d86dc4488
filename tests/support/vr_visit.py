"""A whole visit with the headset's page: emulated headset, scripted participant, tablet, operator.

The page is the one that is shipped, on the real server, with its own policy. Only the device is
emulated (`frontend/src/vr/testing`): a script that is injected before the page's own gives the
browser a headset, a clock that the test steps, and a participant who wears it. Everything else is
real: pairing, the socket, the workers, the session and its record.
"""

import base64
import time
import uuid
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import httpx2
from playwright.sync_api import BrowserContext, Page

from app.protocol import STEP_KINDS
from app.simulated_people.body import Person
from tests.e2e.scripted_tablet import ScriptedTablet
from tests.support.bundle import bundled_script

Json = dict[str, Any]
FRAME_RATE_HZ = 90
JOURNEY = "vr/testing/journey.ts"
PATIENCE_MS = 60_000
ENDED = ("completed", "aborted", "withdrawn")
OVERTAKEN = ("stale", "not_now")
"""Error codes of a command that came after the headset's own change."""
FRAMES_AT_ONCE, FRAMES_OF_A_PHASE = 45, 360
"""Frames between two looks of the operator, who has nothing to do while a phase runs."""
SPAN_BY_STATURE = 1.03
"""As of British men in the median (Pheasant 1996); the product's usual skeleton has 1.14."""
QUICK = {
    "reactionS": 0.2,
    "tempo": 0.75,
    "precision": 1.0,
    "footTempo": 1.0,
    "patienceS": 1.0,
}
"""How a person moves who needs little time for a task, for visits with short phases."""
# Read in the task that draws it: the browser empties the canvas afterwards.
PICTURE = """(drawing) => {
    const drawn = globalThis[drawing];
    const before = drawn.isRendering;
    drawn.isRendering = true;
    journey.clock.step();
    drawn.isRendering = before;
    return document.querySelector("[data-webxr_runtime] canvas").toDataURL("image/png");
}"""


def journey_script(folder: Path) -> Path:
    """Bundle the emulated headset and its wearer into one script in `folder`."""
    return bundled_script(JOURNEY, folder)


class WornHeadset:
    """The headset's page with an emulated headset that a scripted participant wears."""

    def __init__(self, context: BrowserContext, script: Path, url: str) -> None:
        self.url = url
        self.page: Page = context.new_page()
        self.page.add_init_script(path=script)

    def open(self, code: str | None = None) -> None:
        """Open the page, with the code of a pairing link."""
        query = "" if code is None else f"?code={code}"
        self.page.goto(f"{self.url}/vr{query}")

    def wear(self, person: Person, seed: int = 1, traits: Json | None = None) -> None:
        """Let this person wear the headset; without `traits` they follow from the seed."""
        foot = "left" if person.build.footedness == "left" else "right"
        wish: Json = {
            "statureM": person.stature_m,
            "spanM": SPAN_BY_STATURE * person.stature_m,
            "seed": seed,
            "footedness": foot,
        }
        if traits is not None:
            wish["traits"] = traits
        self.page.evaluate("(wish) => journey.wear(wish)", wish)

    def enter(self, button: str = "Enter VR") -> None:
        """Press the button and wait until the page draws its first frame in VR."""
        self.page.get_by_role("button", name=button).click(timeout=PATIENCE_MS)
        # `wait_for_function` would poll by frames, which come only when they are stepped.
        self.until("globalThis.journey.headset.session !== null")
        self.until("globalThis.reembody.granted !== null")

    def until(self, condition: str, timeout_ms: float = PATIENCE_MS) -> None:
        """Wait until a JavaScript expression is true, without drawing frames."""
        self.page.wait_for_function(f"() => {condition}", polling=20, timeout=timeout_ms)

    def step(self, frames: int, frame_s: float | None = None) -> float:
        """Draw frames, at the device's rate or so far apart; return the time of the last one, s."""
        given = [frames, None if frame_s is None else 1000.0 * frame_s]
        return float(self.page.evaluate("([frames, ms]) => journey.step(frames, ms)", given))

    def act(self, frames: int) -> int:
        """Draw as the participant acts, at most as many frames; return how many."""
        return int(self.page.evaluate("(frames) => journey.act(frames)", frames))

    def picture(self, drawing: str = "reembody") -> bytes:
        """Draw a frame and return what both eyes see in it as a PNG file.

        `drawing`: the global object of what draws it, the visit or a self-test.
        """
        data = str(self.page.evaluate(PICTURE, drawing))
        return base64.b64decode(data.partition(",")[2])

    def tell(self, expression: str) -> Any:
        """Return the value of a JavaScript expression in the page."""
        return self.page.evaluate(f"() => {expression}")

    def do(self, statement: str) -> None:
        """Run a JavaScript statement in the page."""
        self.page.evaluate(f"() => {{ {statement} }}")


@dataclass
class Visit:
    """A session with an operator who issues commands, and a headset that a script wears.

    `at_step` is called whenever another step begins, with its key; `drawn_s` is the time that the
    headset has drawn.
    """

    operator: httpx2.Client
    session_id: str
    headset: WornHeadset
    person: Person
    at_step: Callable[[str], None] = lambda _: None
    frames: int = 0
    took_s: float = 0.0
    _shown: str | None = field(default=None, init=False)

    @property
    def drawn_s(self) -> float:
        """The time that the headset has drawn, s."""
        return self.frames / FRAME_RATE_HZ

    def view(self) -> Json:
        """Return the session as its operator sees it."""
        view: Json = ok(self.operator.get(f"/api/sessions/{self.session_id}"))
        return view

    def command(self, view: Json, kind: str, **fields: Any) -> bool:
        """Send a command; return whether it was not overtaken by another change."""
        body = {
            "command_id": str(uuid.uuid4()),
            "expected_version": view["version"],
            "type": kind,
            **fields,
        }
        answer = self.operator.post(f"/api/sessions/{self.session_id}/commands", json=body)
        if answer.is_success:
            return True
        code = answer.json()["error"]["code"]
        assert code in OVERTAKEN, answer.text
        return False

    def perform(self, until: Callable[[Json], bool] = lambda _: False) -> Json:
        """Play operator and wearer until the session has ended, or until a view is as asked."""
        while True:
            view = self.view()
            if view["status"] in ENDED or until(view):
                return view
            current = view["current"]
            if current is not None:
                key = view["steps"][current["index"]]["key"]
                if key != self._shown:
                    self._shown = key
                    self.at_step(key)
            self._operate(view)
            self._act(FRAMES_OF_A_PHASE if _is_running(view) else FRAMES_AT_ONCE)

    def perform_slowly(self, until: Callable[[Json], bool]) -> Json:
        """Draw one frame between looks until a view is as asked: the server hears with a delay."""
        while not until(view := self.view()):
            self._act(1)
        return view

    def draw(self, frames: int) -> None:
        """Draw as many frames; the participant presses both grips to step into the figure."""
        while frames > 0:
            frames -= self._act(frames)

    def _act(self, frames: int) -> int:
        """Draw at most as many frames, fewer if the session's state changes; return how many."""
        began_s = time.monotonic()
        drawn = self.headset.act(frames)
        self.frames += drawn
        self.took_s += time.monotonic() - began_s
        return drawn

    def _operate(self, view: Json) -> None:
        if view["status"] == "planned":
            self.command(view, "start")
            return
        if view["held"] is not None:
            self.command(view, "override_stop", reason="Nobody is unwell: it is a script.")
            return
        current = view["current"]
        step = view["steps"][current["index"]]
        spec = STEP_KINDS[step["kind"]]
        if spec.command == "complete_step" and spec.screen == "waiting":
            self.command(view, "complete_step", **self._measured(spec.key))
        elif spec.family == "timed":
            if current["status"] == "ready":
                self.command(view, "begin_phase")
            elif current["status"] == "paused" and not current["resuming"]:
                self.command(view, "resume")

    def _measured(self, kind: str) -> Json:
        if kind != "height":
            return {}
        stature_m = round(self.person.stature_m, 3)
        return {"height_m": {"stated": round(stature_m, 2), "matched": stature_m}}


def _is_running(view: Json) -> bool:
    current = view["current"]
    return current is not None and current["status"] == "running"


def begun(
    operator: httpx2.Client,
    context: BrowserContext,
    script: Path,
    url: str,
    study: str,
    *,
    time_scale: float,
    traits: Json | None = None,
) -> tuple[Visit, ScriptedTablet]:
    """Create a simulated session with a paired tablet and a worn headset, not started yet."""
    fields = {"kind": "simulated", "language": "en", "time_scale": time_scale}
    session_id = str(ok(operator.post(f"/api/studies/{study}/sessions", json=fields))["id"])

    def code(device: str) -> str:
        path = f"/api/sessions/{session_id}/pairings"
        return str(ok(operator.post(path, json={"device": device}))["code"])

    tablet = ScriptedTablet(url, code("tablet"))
    headset = WornHeadset(context, script, url)
    headset.open(code("headset"))
    headset.wear(tablet.person, traits=traits)
    headset.enter()
    headset.do("reembody.isRendering = false")
    return Visit(operator, session_id, headset, tablet.person), tablet


def ok(answer: httpx2.Response) -> Any:
    """Return the body of an answer that must be a success."""
    assert answer.is_success, f"{answer.request.method} {answer.request.url}: {answer.text}"
    return answer.json()
