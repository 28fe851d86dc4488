"""Observe a server from outside while it cannot write and headsets stream.

The observer sends requests throughout, as people would: reads, notes, starts and health checks. It
records every response, when the alarm became visible, when a new start was rejected, and when the
server had recovered.
"""

import asyncio
import json
import time
import uuid
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any

from httpx2 import AsyncClient, Response

from tests.faults.streaming import StreamingHeadset, stream
from tests.rehearsal.performed import STUDY
from tests.support.server import ADMIN_PASSWORD, LiveServer

BEFORE_S, AFTER_S, LOOK_EVERY_S = 1.5, 1.0, 0.05
GIVE_UP_S = 30.0
READS = (f"/api/studies/{STUDY}/sessions", "/api/studies", f"/api/studies/{STUDY}/ledger")


@dataclass
class Watch:
    """The observations made during one outage.

    Times in s: `noticed_s` from the cause to the alarm; `alarm_s` and `refusal_s` since the first
    commit that failed; `recovery_s` since the server could write again. `acked_during`: messages
    that were acknowledged although nothing could be stored. `console`: the storage statuses that an
    open page received. `answers`: the number of responses by (reads, writes) and status.
    """

    noticed_s: float = float("nan")
    alarm_s: float = float("nan")
    refusal_s: float = float("nan")
    recovery_s: float = float("nan")
    restart_s: float = float("nan")
    longest_wait_s: float = 0.0
    longest_queue: int = 0
    acked_during: int = 0
    reason: str = ""
    console: list[str] = field(default_factory=list)
    refusals: list[dict[str, Any]] = field(default_factory=list)
    answers: Counter[tuple[str, int]] = field(default_factory=Counter)


@dataclass
class Outage:
    """An outage of storage: `begin` makes writing impossible, `end` makes it possible again.

    It lasts `lasts_s`. `latecomer` connects its headset only when nothing can be written any more.
    """

    server: LiveServer
    headsets: Sequence[StreamingHeadset]
    begin: Callable[[], object]
    end: Callable[[], object]
    lasts_s: float
    latecomer: StreamingHeadset | None = None
    watch: Watch = field(default_factory=Watch)
    _streaming: bool = True

    async def run(self) -> Watch:
        """Stream, cause the outage in the middle, and wait until everything is acknowledged."""
        async with AsyncClient(base_url=self.server.url, timeout=GIVE_UP_S) as client:
            credentials = {"username": "admin", "password": ADMIN_PASSWORD}
            (await client.post("/api/login", json=credentials)).raise_for_status()
            async with asyncio.TaskGroup() as group:
                group.create_task(self._stream(self.headsets))
                try:
                    await asyncio.sleep(BEFORE_S)
                    await self._outage(client, group)
                    await asyncio.sleep(AFTER_S)
                finally:
                    self._streaming = False
        return self.watch

    async def _stream(self, headsets: Sequence[StreamingHeadset]) -> None:
        await stream(self.server, headsets, lambda: self._streaming)

    async def _outage(self, client: AsyncClient, group: asyncio.TaskGroup) -> None:
        planned = await self._new_session(client)
        listening = asyncio.create_task(self._listen(client, planned))
        # What the page receives begins with the status before the outage.
        await self._until(client, lambda _: self.watch.console == ["ok"])
        began_s = time.monotonic()
        self.begin()
        try:
            # A request made before the failure is detected waits longest.
            first = asyncio.create_task(self._command(client, planned, "note"))
            since = await self._alarm(client)
            self.watch.noticed_s = time.monotonic() - began_s
            await first
            if self.latecomer is not None:
                group.create_task(self._stream([self.latecomer]))
            acked = self._acked()
            async with asyncio.TaskGroup() as asking:
                asking.create_task(self._ask_to_start(client, planned, since))
                asking.create_task(self._keep_asking(client, planned, began_s + self.lasts_s))
            self.watch.acked_during = self._acked() - acked
        finally:
            self.end()
        ended_s = time.monotonic()
        await self._until(client, lambda health: health["storage"] == "ok")
        self.watch.recovery_s = time.monotonic() - ended_s
        started = await self._command(client, planned, "start")
        assert started.status_code == 200, started.text
        self.watch.restart_s = time.monotonic() - ended_s
        # The page is told over another connection, on a slow machine a moment later.
        await self._until(client, lambda _: self.watch.console[-1:] == ["ok"])
        listening.cancel()

    async def _listen(self, client: AsyncClient, session_id: str) -> None:
        """Record the storage statuses that the page of a session receives."""
        async with client.stream("GET", f"/api/sessions/{session_id}/live") as answer:
            told = ""
            async for line in answer.aiter_lines():
                if line.startswith("data:") and told == "storage":
                    self.watch.console.append(json.loads(line[5:])["status"])
                told = line.removeprefix("event:").strip() if line.startswith("event:") else told

    async def _alarm(self, client: AsyncClient) -> datetime:
        """Wait until health reports the failure; return when the first commit failed."""
        health = await self._until(client, lambda health: health["storage"] == "failing")
        since = datetime.fromisoformat(health["storage_since"])
        self.watch.alarm_s = _seconds_since(since)
        self.watch.reason = health["storage_reason"]
        return since

    async def _ask_to_start(self, client: AsyncClient, planned: str, since: datetime) -> None:
        """Send every kind of request that would start something; each is rejected."""
        pairing = {"device": "tablet"}
        self.watch.refusals = [
            _refusal(await self._command(client, planned, "start")),
            _refusal(await self._post(client, f"/api/studies/{STUDY}/sessions", {"kind": "test"})),
            _refusal(await self._post(client, f"/api/sessions/{planned}/pairings", pairing)),
        ]
        self.watch.refusal_s = _seconds_since(since)

    async def _keep_asking(self, client: AsyncClient, planned: str, until_s: float) -> None:
        while time.monotonic() < until_s:
            for path in READS:
                await self._get(client, path)
            for headset in self.headsets:
                await self._get(client, f"/api/sessions/{headset.session_id}")
            await self._command(client, planned, "note")
            await asyncio.sleep(LOOK_EVERY_S)
            self._look_at_queue()

    async def _until(
        self, client: AsyncClient, is_it: Callable[[dict[str, Any]], bool]
    ) -> dict[str, Any]:
        async with asyncio.timeout(GIVE_UP_S):
            while True:
                answer = await self._get(client, "/api/health")
                health: dict[str, Any] = answer.json()
                if answer.is_success and is_it(health):
                    return health
                self._look_at_queue()
                await asyncio.sleep(LOOK_EVERY_S)

    async def _new_session(self, client: AsyncClient) -> str:
        body = {"kind": "test"}
        answer = await client.post(f"/api/studies/{STUDY}/sessions", json=body)
        answer.raise_for_status()
        return str(answer.json()["id"])

    async def _command(self, client: AsyncClient, session_id: str, kind: str) -> Response:
        body = {"command_id": str(uuid.uuid4()), "expected_version": 0, "type": kind, "text": "x"}
        if kind == "start":
            view = await self._get(client, f"/api/sessions/{session_id}")
            body["expected_version"] = view.json()["version"]
        return await self._post(client, f"/api/sessions/{session_id}/commands", body)

    async def _get(self, client: AsyncClient, path: str) -> Response:
        return self._note("reads", time.monotonic(), await client.get(path))

    async def _post(self, client: AsyncClient, path: str, body: dict[str, Any]) -> Response:
        began_s = time.monotonic()
        return self._note("writes", began_s, await client.post(path, json=body))

    def _note(self, what: str, began_s: float, answer: Response) -> Response:
        if what == "writes":
            self.watch.longest_wait_s = max(self.watch.longest_wait_s, time.monotonic() - began_s)
        self.watch.answers[what, answer.status_code] += 1
        return answer

    def _acked(self) -> int:
        return sum(sum(headset.ledger.acked.values()) for headset in self.headsets)

    def _look_at_queue(self) -> None:
        longest = max(len(headset.ledger) for headset in self.headsets)
        self.watch.longest_queue = max(self.watch.longest_queue, longest)


def _refusal(answer: Response) -> dict[str, Any]:
    assert answer.status_code == 503, (answer.status_code, answer.text)
    refusal: dict[str, Any] = answer.json()["error"]
    return refusal


def _seconds_since(moment: datetime) -> float:
    return (datetime.now(UTC) - moment).total_seconds()
