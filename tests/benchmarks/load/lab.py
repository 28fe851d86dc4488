"""The study of the load, and sessions that only need their headsets."""

import uuid
from dataclasses import dataclass
from typing import Any

import httpx2

from tests.benchmarks.load.generator import Seat
from tests.protocol.helpers import STUDY as FILE
from tests.support.server import ADMIN_PASSWORD, LiveServer

STUDY = "load"
# Longer than any run, with only free movement.
PROCEDURE = """procedure:
  before:
    - {step: materialise, text: t_pose}
    - {step: free_roam, duration_s: 86400, latency_ms: 125, text: free_roam}
"""


@dataclass(frozen=True)
class Lab:
    """A set of sessions that are ready for their headsets' frames."""

    seats: tuple[Seat, ...]
    cookies: dict[str, str]


def make_lab(server: LiveServer, count: int, first: int = 0) -> Lab:
    """Create `count` started sessions with paired headsets, numbered from `first`."""
    with server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        if first == 0:
            client.post("/api/studies", json={"yaml": study_text()}).raise_for_status()
        seats = tuple(_seat(client, first + at) for at in range(count))
        return Lab(seats, dict(client.cookies))


def call_phases(server: LiveServer, lab: Lab) -> None:
    """Let every participant enter the body and begin the phase; headsets must be connected."""
    with server.client() as client:
        client.cookies.update(lab.cookies)
        for seat in lab.seats:
            for command in ("materialise", "begin_phase"):
                _command(client, f"/api/sessions/{seat.session_id}", command)


def study_text() -> str:
    """Return the shipped study with another start; lost headsets resume from the journal."""
    text = FILE
    start, end = text.index("procedure:\n"), text.index("  block:\n")
    text = text[:start] + PROCEDURE + text[end:]
    text = text.replace("on_disconnect: pause", "on_disconnect: continue", 1)
    return text.replace("key: reembodiment-latency", f"key: {STUDY}", 1)


def _seat(client: httpx2.Client, number: int) -> Seat:
    view = _post(client, f"/api/studies/{STUDY}/sessions", {"kind": "simulated"})
    at = f"/api/sessions/{view['id']}"
    shown = _post(client, f"{at}/pairings", {"device": "headset"})
    token = str(_post(client, "/api/devices/pair", {"code": shown["code"]})["token"])
    view = _command(client, at, "start")
    return Seat(number, str(view["id"]), token)


def _command(client: httpx2.Client, at: str, kind: str) -> dict[str, Any]:
    """Send a command based on the newest view."""
    view = client.get(at).json()
    body = {"command_id": str(uuid.uuid4()), "expected_version": view["version"], "type": kind}
    return _post(client, f"{at}/commands", body)


def _post(client: httpx2.Client, path: str, body: dict[str, Any]) -> dict[str, Any]:
    response = client.post(path, json=body)
    if response.is_error:
        raise RuntimeError(f"POST {path} {body}: {response.status_code} {response.text[:500]}")
    answered: dict[str, Any] = response.json()
    return answered
