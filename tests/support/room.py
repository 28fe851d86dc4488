"""The headset's room in an emulated headset, for tests and benchmarks.

`opened_room` bundles the page `vr/testing/roomPage.ts`, opens it, and lets a script draw
moments: each gives a picture of both eyes and what drawing it took. Nothing is served: the
browser's requests are answered from the bundle.
"""

import base64
import json
import mimetypes
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from PIL import Image
from playwright.sync_api import BrowserContext, Page, Route

from app.adapters.humanoids import read_humanoid
from tests.adapters.humanoids.vector_files import binding_json
from tests.support.bundle import BASE, SCRIPT, bundled

ROOT = Path(__file__).resolve().parents[2]
BODIES = ROOT / "study_configs/bodies"
ORIGIN = "http://localhost"
"""A secure context; nothing listens there."""
SIZE_PX = (960, 480)
"""Both eyes beside each other."""
Moment = Mapping[str, Any]

_ARMS_DOWN: dict[str, Any] = {
    "LeftUpperArm": [["z", 78]],
    "RightUpperArm": [["z", -78]],
    "LeftLowerArm": [["y", -12]],
    "RightLowerArm": [["y", 12]],
}
_REACHING = {
    **_ARMS_DOWN,
    "RightUpperArm": [["y", 75], ["z", -38]],
    "RightLowerArm": [["y", 25]],
}
_WAVING = {**_ARMS_DOWN, "RightUpperArm": [["z", -20]], "RightLowerArm": [["z", 95]]}
_STEPPING = {
    **_ARMS_DOWN,
    "RightUpperLeg": [["x", 38]],
    "RightLowerLeg": [["x", -48]],
    "RightFoot": [["x", 8]],
}


def visible(*setups: str, **parts: bool) -> dict[str, Any]:
    """Return `Visible` (`world.ts`): the parts given, and the boxes of these limbs."""
    nothing = {"local": False, "remote": False, "figure": False, "devices": False}
    return {**nothing, **parts, "setups": list(setups)}


_HAND_TASK = {
    "limb": "hand",
    "goal": "hand/2/panel",
    "green": ["hand/4/panel", "hand/3/panel"],
    "red": ["hand/2/left"],
    "numbers": [4, 3, 2, 1],
}
_FOOT_TASK = {
    "limb": "foot",
    "goal": "foot/2/panel",
    "green": ["foot/1/panel"],
    "red": ["foot/2/right"],
    "numbers": [1, 2, 3, 4],
}
MOMENTS: dict[str, Moment] = {
    "stepping_in": {
        "pose": _ARMS_DOWN,
        "visible": visible(figure=True, devices=True),
        "controllers": True,
        "from": {"positionM": [0.35, 1.62, 1.5], "rotation": [0.9945, -0.06, 0.085, 0]},
    },
    "free_roam": {
        "pose": _WAVING,
        "lookDeg": {"pitch": -12, "yaw": 0},
        "visible": visible("hand", "foot", local=True, remote=True),
        "remainingS": 118,
    },
    "hand_task": {
        "pose": _REACHING,
        "lookDeg": {"pitch": -32, "yaw": -8},
        "visible": visible("hand", remote=True),
        "task": _HAND_TASK,
        "remainingS": 41.2,
        "completed": 3,
    },
    "foot_task": {
        "pose": _STEPPING,
        "lookDeg": {"pitch": -50, "yaw": 0},
        "visible": visible("foot", remote=True),
        "task": _FOOT_TASK,
        "remainingS": 12,
        "completed": 11,
    },
    "mirror": {
        "pose": _WAVING,
        "lookDeg": {"pitch": -4, "yaw": 0},
        "visible": visible(remote=True),
        "remainingS": 60,
        "completed": 0,
    },
}
"""Moments of a visit in the shipped study, as its participant sees them."""
EVERYTHING: Moment = {
    **MOMENTS["hand_task"],
    "visible": visible("hand", "foot", local=True, remote=True, figure=True, devices=True),
    "controllers": True,
    "isBoundarySmall": True,
    "isCurtainDrawn": True,
    "frames": 9,
    "panel": "question",
}
"""All that can be seen at once, with a panel that is pointed at; more than a visit ever shows."""
ACCOMPANIED: Moment = {
    **EVERYTHING,
    "visible": visible("hand", "foot", local=True, remote=True),
    "controllers": False,
    "companionAtM": [1.55, 0, -0.9],
    "panel": "stopping",
}
"""All that can be seen at once beside a companion, who is there in the body only."""
PAUSED: Moment = {**EVERYTHING, "panel": "pause", "frames": 60}
"""The pause room, when the room has given way to it."""
IN_FRONT: Moment = {
    "pose": _ARMS_DOWN,
    "visible": visible(remote=True),
    "from": {"positionM": [0.3, 1.6, -1.2], "rotation": [0, 0, 1, 0]},
}
"""Somebody else's view of the wearer, from between the body and the glass."""


@dataclass(frozen=True)
class Drawn:
    """A picture of both eyes, and what drawing one of them took."""

    calls: float
    triangles: float
    target_switches: int
    heads_px: tuple[tuple[float, float], ...]
    """The middle of the wearer's head in the picture of each eye, whether it is seen or not."""
    reflected_heads_px: tuple[tuple[float, float], ...]
    png: bytes

    @property
    def pixels(self) -> NDArray[np.int16]:
        """Red, green and blue, 0 to 255, of (height, width)."""
        picture = Image.open(BytesIO(self.png)).convert("RGB")
        return np.asarray(picture).astype(np.int16)

    def eye(self, index: int) -> NDArray[np.int16]:
        """Return the pixels of the left (0) or the right (1) eye."""
        half = SIZE_PX[0] // 2
        return self.pixels[:, index * half : (index + 1) * half]


@dataclass(frozen=True)
class Room:
    """A room that is open in a browser."""

    page: Page

    def draw_fading(self, moment: Moment) -> Drawn:
        """Show a moment while the curtain closes before it, when most is drawn at once."""
        self.draw({**moment, "isCurtainDrawn": False, "panel": None, "frames": 30})
        return self.draw(moment)

    def draw(self, moment: Moment) -> Drawn:
        """Show a moment (`Moment` in `roomPage.ts`) to both eyes."""
        drawn = self.page.evaluate("(moment) => room.draw(moment)", dict(moment))
        return Drawn(
            calls=float(drawn["calls"]),
            triangles=float(drawn["triangles"]),
            target_switches=int(drawn["targetSwitches"]),
            heads_px=tuple((x, y) for x, y in drawn["headPx"]),
            reflected_heads_px=tuple((x, y) for x, y in drawn["reflectedHeadPx"]),
            png=base64.b64decode(drawn["png"]),
        )


@contextmanager
def opened_room(
    context: BrowserContext,
    folder: Path,
    study: Mapping[str, Any],
    *,
    body: str | None = "neutral",
    palette: str = "standard",
    language: str = "en",
    stature_m: float = 1.75,
    mirror: str = "double",
) -> Iterator[Room]:
    """Open the room of a study's tasks; `folder` holds the bundle, which is made once.

    `body` names one of the shipped bodies, None the plain one; `mirror` is `double` or three's
    `reflector`.
    """
    if not (folder / SCRIPT).exists():
        bundled("vr/testing/roomPage.ts", folder)

    def answer(route: Route) -> None:
        name = route.request.url.removeprefix(ORIGIN).removeprefix(BASE)
        file = folder / name
        if not file.is_file():
            route.fulfill(body="<!doctype html><body style='margin:0'>", content_type="text/html")
            return
        kind = mimetypes.guess_type(name)[0] or "application/octet-stream"
        route.fulfill(body=file.read_bytes(), content_type=kind)

    context.route(f"{ORIGIN}/**", answer)
    page = context.new_page()
    # The emulated headset draws to the whole window.
    page.set_viewport_size({"width": SIZE_PX[0], "height": SIZE_PX[1]})
    page.goto(f"{ORIGIN}/room")
    page.evaluate("(address) => import(address)", f"{BASE}{SCRIPT}")
    options = {
        "tasks": study["tasks"],
        "appearance": study["appearance"],
        "palette": palette,
        "language": language,
        "statureM": stature_m,
        "body": None if body is None else _body(body),
        "mirror": mirror,
        "sizePx": list(SIZE_PX),
    }
    page.evaluate("(options) => room.open(options)", json.loads(json.dumps(options)))
    yield Room(page)
    page.close()


def _body(name: str) -> dict[str, Any]:
    data = (BODIES / f"{name}.glb").read_bytes()
    return {
        "file": base64.b64encode(data).decode(),
        "binding": binding_json(read_humanoid(data).binding),
    }
