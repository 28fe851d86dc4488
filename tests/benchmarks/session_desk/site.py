"""A server with studies made for measurements, and signed-in accounts."""

import uuid
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

import httpx2
import yaml

from app.resources import study_configs_dir
from tests.protocol.helpers import STUDY as FILE
from tests.support.server import ADMIN_PASSWORD, LiveServer

FORMS = "forms"
INSTRUMENT = "karas2020"
ITEMS = 14
"""The rated statements of the form; an optional open question follows them."""


@dataclass(frozen=True)
class Desk:
    """An operator's signed-in HTTP calls to the server."""

    server: LiveServer
    client: httpx2.Client

    def post(self, path: str, body: dict[str, Any]) -> Any:
        """Send a POST request; raise RuntimeError with the server's message if it is rejected."""
        response = self.client.post(path, json=body)
        if response.is_error:
            raise RuntimeError(f"POST {path}: {response.status_code} {response.text[:500]}")
        return response.json()

    def add_forms_study(self, forms: int) -> None:
        """Store a study that consists of the same form, repeated."""
        step = f"    - {{step: form, instrument: {INSTRUMENT}}}\n"
        text = FILE
        start, end = text.index("procedure:\n"), text.index("  block:\n")
        text = f"{text[:start]}procedure:\n  before:\n{step * forms}{text[end:]}"
        text = text.replace("key: reembodiment-latency", f"key: {FORMS}", 1)
        self.post("/api/studies", {"yaml": text})

    def tablet_at_form(self) -> str:
        """Return the cookie of a tablet whose session has started."""
        view = self.post(f"/api/studies/{FORMS}/sessions", {"kind": "simulated"})
        at = f"/api/sessions/{view['id']}"
        code = self.post(f"{at}/pairings", {"device": "tablet"})["code"]
        with self.server.client() as tablet:
            tablet.post("/api/devices/pair", json={"code": code}).raise_for_status()
            cookie = "; ".join(f"{name}={value}" for name, value in tablet.cookies.items())
        version = self.client.get(at).json()["version"]
        command = {"command_id": str(uuid.uuid4()), "expected_version": version, "type": "start"}
        self.post(f"{at}/commands", command)
        return cookie


def statements() -> list[str]:
    """Return the wordings of the rated statements, in English."""
    file = study_configs_dir() / "instruments" / f"{INSTRUMENT}.yaml"
    items = yaml.safe_load(file.read_text(encoding="utf-8"))["items"]
    return [str(one["text"]["en"]) for one in items if one["type"] == "likert"]


@contextmanager
def signed_in(server: LiveServer) -> Iterator[Desk]:
    """Sign the administrator in at a running server."""
    with server.client() as client:
        credentials = {"username": "admin", "password": ADMIN_PASSWORD}
        client.post("/api/login", json=credentials).raise_for_status()
        yield Desk(server, client)
