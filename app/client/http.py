"""HTTP clients of an operator and a tablet, whose errors contain the server's own message.

A device on a lab's network retries a request that gets no response: all its requests are
idempotent. A command keeps its id and a form its key over all attempts, so that an attempt whose
response was lost is answered like the first.
"""

import asyncio
import time
import uuid
from dataclasses import dataclass
from typing import Any

from httpx2 import AsyncClient, HTTPError, Response

from app.errors import as_sentences

Json = dict[str, Any]
PATIENCE_S = 60.0
RETRY_S = (0.05, 0.1, 0.2, 0.5, 1.0)
CODE_USED = 410
SERVER_AT_FAULT = 500


class ServerRefusedError(RuntimeError):
    """The server refused a request; the message contains its reason and remedy, `code` its code."""

    def __init__(self, status: int, error: Json) -> None:
        super().__init__(as_sentences(error.get("message", "refused"), error.get("remedy") or ""))
        self.status = status
        self.code = str(error.get("code", ""))
        self.error = error


class UnreachableError(RuntimeError):
    """The request got no response from any server at the address."""


async def call(client: AsyncClient, method: str, path: str, body: Json | None = None) -> Any:
    """Send a request; return the decoded JSON, or None if the response has no content.

    Raises ServerRefusedError or UnreachableError.
    """
    try:
        response = await client.request(method, path, json=body)
    except HTTPError as error:
        raise UnreachableError(f"no answer from {client.base_url}: {error}") from error
    return _decoded(response)


async def call_with_retry(
    client: AsyncClient,
    method: str,
    path: str,
    body: Json | None = None,
    *,
    patience_s: float = PATIENCE_S,
) -> Any:
    """Repeat `call` until it gets a response; only for idempotent requests.

    Raises ServerRefusedError immediately if the server refuses the request. If the server cannot be
    reached, or fails (status 5xx), for longer than `patience_s`, it raises the last error of
    `call`.
    """
    give_up_s = time.monotonic() + patience_s
    attempt = 0
    while True:
        try:
            return await call(client, method, path, body)
        except (UnreachableError, ServerRefusedError) as error:
            final = isinstance(error, ServerRefusedError) and error.status < SERVER_AT_FAULT
            if final or time.monotonic() >= give_up_s:
                raise
        await asyncio.sleep(RETRY_S[min(attempt, len(RETRY_S) - 1)])
        attempt += 1


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
    """An operator's requests for one session."""

    client: AsyncClient
    session_id: str

    async def view(self) -> Json:
        """Return the session as the cockpit shows it."""
        view: Json = await call_with_retry(self.client, "GET", f"/api/sessions/{self.session_id}")
        return view

    async def command(self, view: Json, kind: str, **fields: Any) -> Json:
        """Send a command based on `view`; every retry has the same command id."""
        return await self._send(kind, {"expected_version": view["version"], **fields})

    async def stop(self, kind: str, **fields: Any) -> Json:
        """Pause, abort or withdraw, even if the session has changed in the meantime."""
        return await self._send(kind, fields)

    async def _send(self, kind: str, fields: Json) -> Json:
        body = {"command_id": str(uuid.uuid4()), "type": kind, **fields}
        path = f"/api/sessions/{self.session_id}/commands"
        result: Json = await call_with_retry(self.client, "POST", path, body)
        return result

    async def pair(self, device: str, client: AsyncClient, name: str) -> Json:
        """Request a pairing code and use it from the device's own client."""
        path = f"/api/sessions/{self.session_id}/pairings"
        while True:
            shown = await call_with_retry(self.client, "POST", path, {"device": device})
            use = {"code": shown["code"], "name": name}
            try:
                paired: Json = await call_with_retry(client, "POST", "/api/devices/pair", use)
            except ServerRefusedError as error:
                # The code was used by an attempt whose response was lost; a new one replaces that
                # pairing.
                if error.status != CODE_USED:
                    raise
            else:
                return paired


@dataclass(frozen=True)
class Tablet:
    """A tablet's requests; its client has the pairing cookie."""

    client: AsyncClient

    async def state(self) -> Json:
        """Return the tablet's current screen."""
        state: Json = await call_with_retry(self.client, "GET", "/api/tablet/state")
        return state

    async def acknowledge(self, step_index: int) -> Json:
        """Confirm that consent was given or instructions were read."""
        state: Json = await call_with_retry(
            self.client, "POST", "/api/tablet/acknowledge", {"step_index": step_index}
        )
        return state

    async def consent(self, step_index: int, given: Json) -> Json:
        """Send a consent with its ticked statements and signature."""
        body = {"step_index": step_index, **given}
        state: Json = await call_with_retry(self.client, "POST", "/api/tablet/consent", body)
        return state

    async def submit(self, administration: Json, answers: Json, idempotency_key: str) -> Json:
        """Send a filled-in form."""
        path = "/api/tablet/submissions"
        return await submit_form(self.client, path, administration, answers, idempotency_key)


async def submit_form(
    client: AsyncClient, path: str, administration: Json, answers: Json, idempotency_key: str
) -> Json:
    """Send a filled-in form to the address of a tablet, a headset or an operator."""
    body = {
        "idempotency_key": idempotency_key,
        "administration": administration["key"],
        "answers": answers,
        "shown_order": administration["item_order"],
        "seed": administration["seed"],
        "language": administration["language"],
    }
    receipt: Json = await call_with_retry(client, "POST", path, body)
    return receipt
