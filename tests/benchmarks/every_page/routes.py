"""Every page of the console, the tablet and the headset's start page, by its route.

The console's routes are those of `frontend/src/console/Routes.tsx`, with each of their tabs.
"""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

_CONSOLE = Path(__file__).parents[3] / "frontend" / "src" / "console"
_TABLE = _CONSOLE / "Routes.tsx"
_PLACES = _CONSOLE / "frame" / "places.ts"

KINDS_OF_RESULTS = "?kind=simulated"


@dataclass(frozen=True)
class Route:
    """A page: how its address is made and who looks at it."""

    name: str
    """The address with a word for each id, as in `/#/sessions/:completed`."""
    reader: str = "operator"
    """Whose cookies are sent; without a reader nobody is signed in or paired."""
    search: str = ""
    allowed: str = ""
    """A regular expression for errors that belong to the page, such as a missing sign-in."""

    waits: bool = False
    """Whether something in the window may wait for as long as no device is there."""

    def address(self, places: Mapping[str, str]) -> str:
        """Return the path with the ids in it."""
        path = self.name.partition(" ")[0]
        for word, place in places.items():
            path = path.replace(f":{word}", place)
        before, hash_, behind = path.partition("#")
        return f"{before}{self.search}{hash_}{behind}"


def _study(tab: str, search: str = "") -> Route:
    return Route(f"/#/studies/:study/{tab}", search=search)


SIGNED_OUT = r"status of 401"
ROUTES: tuple[Route, ...] = (
    Route("/ (signed out)", reader="", allowed=SIGNED_OUT),
    Route("/#/join/:invitation", reader="", allowed=SIGNED_OUT),
    Route("/#/"),
    Route("/#/new"),
    Route("/#/new/study/:study"),
    _study("overview"),
    _study("ledger"),
    _study("sessions"),
    _study("participants"),
    _study("summary", KINDS_OF_RESULTS),
    _study("dashboard", KINDS_OF_RESULTS),
    _study("statistics", KINDS_OF_RESULTS),
    _study("preregistration"),
    _study("export"),
    _study("pilot"),
    _study("protocol"),
    _study("versions"),
    _study("suggestions"),
    Route("/#/studies/:study/edit"),
    Route("/#/sessions/:planned"),
    Route("/#/sessions/:running", waits=True),
    Route("/#/sessions/:completed"),
    Route("/#/sessions/:completed/replay"),
    Route("/#/sessions/:completed/consent"),
    Route("/#/sessions/:planned/outage"),
    Route("/#/instruments"),
    Route("/#/instruments/new"),
    Route("/#/instruments/:instrument/items"),
    Route("/#/instruments/:instrument/scoring"),
    Route("/#/instruments/:instrument/try"),
    Route("/#/instruments/:instrument/file"),
    Route("/#/instruments/:instrument/edit"),
    Route("/#/captures"),
    Route("/#/captures/:capture/movement"),
    Route("/#/captures/:capture/joints"),
    Route("/#/captures/:capture/verification"),
    Route("/#/bodies"),
    Route("/#/bodies/:body"),
    Route("/#/avatars"),
    Route("/#/avatars/:avatar"),
    Route("/#/walking/ask"),
    Route("/#/walking/models"),
    Route("/#/walking/scenes"),
    Route("/#/walking/models/:model"),
    Route("/#/equipment"),
    Route("/#/trackers"),
    Route("/#/network"),
    Route("/#/storage"),
    Route("/#/people/people"),
    Route("/#/people/invitations"),
    Route("/#/people/audit"),
    Route("/#/help"),
    Route("/#/help/statistics"),
    Route("/#/nowhere"),
    Route("/tablet/ (not paired)", reader="", allowed=SIGNED_OUT),
    Route("/tablet/ (consent)", reader="tablet, consent"),
    Route("/tablet/ (form)", reader="tablet, form"),
    Route("/vr/", reader="", allowed=SIGNED_OUT),
)


def forgotten_paths() -> list[str]:
    """Return the paths of the console, also of a study's sections, that no route here leads to."""
    looked_at = [route.name.removeprefix("/#") for route in ROUTES]
    paths = re.findall(r'path="([^"]+)"', _TABLE.read_text(encoding="utf-8"))
    sections = re.findall(r'section: "([^"]+)"', _PLACES.read_text(encoding="utf-8"))
    paths += [f"/studies/:study/{section}" for section in sections]
    return [path for path in paths if not any(map(_pattern(path).fullmatch, looked_at))]


def _pattern(path: str) -> re.Pattern[str]:
    """Return what matches the addresses of a path such as `/captures/:id/:tab?`."""
    return re.compile(re.sub(r"/:\w+", "/[^/]+", re.sub(r"/:\w+\?", "(/[^/]+)?", path)))
