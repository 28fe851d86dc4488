"""An operator and a headset that connect over the network."""

import json

import httpx2
from websockets.asyncio.client import connect

from app.wire.messages import PROTOCOL_VERSION, SUBPROTOCOL
from tests.features.lab import STUDY, ok
from tests.support.server import ADMIN_PASSWORD

CREDENTIALS = {"username": "admin", "password": ADMIN_PASSWORD}


def pair_headset(client: httpx2.Client) -> tuple[str, str]:
    """Pair a headset with a new session; return the session's id and the headset's token."""
    session = ok(client.post(f"/api/studies/{STUDY}/sessions", json={"kind": "test"}))
    shown = ok(client.post(f"/api/sessions/{session['id']}/pairings", json={"device": "headset"}))
    paired = ok(client.post("/api/devices/pair", json={"code": shown["code"]}))
    return session["id"], paired["token"]


async def greeted(url: str, token: str, **options: object) -> dict[str, object]:
    """Connect as a headset and return the server's welcome."""
    async with connect(
        f"{url.replace('http', 'ws', 1)}/api/vr/stream",
        subprotocols=[SUBPROTOCOL, f"bearer.{token}"],  # type: ignore[list-item]  # a token is a plain str
        **options,  # type: ignore[arg-type]  # handed on
    ) as connection:
        hello = {"type": "hello", "protocol": PROTOCOL_VERSION, "client": "test"}
        await connection.send(json.dumps({**hello, "avatars": ["delayed_copy", "physics"]}))
        answer: dict[str, object] = json.loads(await connection.recv())
        return answer
