"""The HTTP side: an operator's and a tablet's calls, with the server's own words in every error."""

import uuid
from dataclasses import dataclass
from typing import Any

from httpx2 import AsyncClient, HTTPError, Response

Json = dict[str, Any]


class ServerRefusedError(RuntimeError):
    """The server said no; the message holds its reason and remedy, `code` its error code."""

    def __init__(self, status: int, error: Json) -> None:
        super().__init__(f"{error.get('message', 'refused')}. {error.get('remedy', '')}".strip())
        self.status = status
        self.code = str(error.get("code", ""))
        self.error = error


class UnreachableError(RuntimeError):
    """Nobody answers at the address."""


async def call(client: AsyncClient, method: str, path: str, body: Json | None = None) -> Any:
    """One request; the decoded JSON, or None where there is none.

    Raises ServerRefusedError or UnreachableError.
    """
    try:
        response = await client.request(method, path, json=body)
    except HTTPError as error:
        raise UnreachableError(f"no answer from {client.base_url}: {error}") from error
    return _decoded(response)


def _decoded(response: Response) -> Any:
    if response.is_success:
        return response.json() if response.content else None
    try:
        error = response.json()["error"]
    except (ValueError, KeyError, TypeError):
        error = {"message": f"status {response.status_code}", "code": "http"}
    raise ServerRefusedError(response.status_code, error)


@dataclass(frozen=True)
class Operator:
    """An experimenter's calls for one session."""

    client: AsyncClient
    session_id: str

    async def view(self) -> Json:
        """The session as the cockpit shows it."""
        view: Json = await call(self.client, "GET", f"/api/sessions/{self.session_id}")
        return view

    async def command(self, view: Json, kind: str, **fields: Any) -> Json:
        """Send a command, decided on `view`."""
        body = {
            "command_id": str(uuid.uuid4()),
            "expected_version": view["version"],
            "type": kind,
            **fields,
        }
        path = f"/api/sessions/{self.session_id}/commands"
        answered: Json = await call(self.client, "POST", path, body)
        return answered

    async def pair(self, device: str, client: AsyncClient, name: str) -> Json:
        """Show a code and use it from the device's own client."""
        path = f"/api/sessions/{self.session_id}/pairings"
        shown = await call(self.client, "POST", path, {"device": device})
        paired: Json = await call(
            client, "POST", "/api/devices/pair", {"code": shown["code"], "name": name}
        )
        return paired


@dataclass(frozen=True)
class Tablet:
    """A tablet's calls; its client holds the pairing cookie."""

    client: AsyncClient

    async def state(self) -> Json:
        """What to show now."""
        state: Json = await call(self.client, "GET", "/api/tablet/state")
        return state

    async def acknowledge(self, step_index: int) -> Json:
        """Consent given or instructions read."""
        state: Json = await call(
            self.client, "POST", "/api/tablet/acknowledge", {"step_index": step_index}
        )
        return state

    async def submit(self, administration: Json, answers: Json, idempotency_key: str) -> Json:
        """Send a filled-in form."""
        body = {
            "idempotency_key": idempotency_key,
            "administration": administration["key"],
            "answers": answers,
            "shown_order": administration["item_order"],
            "seed": administration["seed"],
            "language": administration["language"],
        }
        receipt: Json = await call(self.client, "POST", "/api/tablet/submissions", body)
        return receipt
