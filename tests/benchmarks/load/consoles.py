"""Run consoles in a separate process: `python -m tests.benchmarks.load.consoles`.

Each follows the live stream of a session and requests its view every two seconds. It uses the
generator's protocol with the parent; it ends after the plan's duration.
"""

import asyncio
import json
import sys
import time
from array import array
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import uvloop
from httpx2 import AsyncClient, Timeout

from tests.support.server import CONNECTIONS

VIEW_EVERY_S = 2.0


@dataclass(frozen=True)
class ConsolePlan:
    """The sessions that have an open console, by number and id; `token` is an operator's."""

    url: str
    cookies: dict[str, str]
    sessions: tuple[tuple[int, str], ...]
    duration_s: float
    news: str
    views: str

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""
        return json.dumps(asdict(self))

    @classmethod
    def from_json(cls, text: str) -> "ConsolePlan":
        """Return the plan of a line made by `as_json`."""
        read: dict[str, Any] = json.loads(text)
        sessions = tuple((int(number), str(key)) for number, key in read["sessions"])
        return cls(**{**read, "sessions": sessions})


@dataclass
class Seen:
    """The times of live events and views, as flat arrays.

    Of each event: session number, headset's clock (s), arrival (s). Of each view: request (s), wait
    (s).
    """

    live: "array[float]"
    views: "array[float]"


async def run(plan: ConsolePlan) -> dict[str, Any]:
    """Open the consoles, watch for the duration, and save the events."""
    seen = Seen(array("d"), array("d"))
    timeout = Timeout(30.0, read=60.0, pool=None)
    async with AsyncClient(
        base_url=plan.url, cookies=plan.cookies, timeout=timeout, limits=CONNECTIONS
    ) as client:
        opened = [asyncio.Event() for _ in plan.sessions]
        tasks = [
            asyncio.create_task(_follow(client, number, key, is_open, seen))
            for (number, key), is_open in zip(plan.sessions, opened, strict=True)
        ]
        await asyncio.gather(*(is_open.wait() for is_open in opened))
        print("connected\nready", flush=True)
        begin_s = float(await asyncio.to_thread(sys.stdin.readline))
        cpu_s = time.process_time()
        tasks += [
            asyncio.create_task(_view(client, at, key, begin_s, seen))
            for at, (_, key) in enumerate(plan.sessions)
        ]
        try:
            done, _ = await asyncio.wait(
                tasks,
                timeout=begin_s + plan.duration_s - time.monotonic(),
                return_when=asyncio.FIRST_EXCEPTION,
            )
            for task in done:
                task.result()
        finally:
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
    np.save(Path(plan.news), np.asarray(seen.live).reshape(-1, 3))
    np.save(Path(plan.views), np.asarray(seen.views).reshape(-1, 2))
    return {"cpu_s": time.process_time() - cpu_s}


async def _follow(
    client: AsyncClient, number: int, session_id: str, is_open: asyncio.Event, seen: Seen
) -> None:
    """Read the live stream as a page does."""
    async with client.stream("GET", f"/api/sessions/{session_id}/live") as response:
        response.raise_for_status()
        kind = ""
        async for line in response.aiter_lines():
            arrived_s = time.monotonic()
            if line.startswith("event: "):
                kind = line[7:]
            elif line.startswith("data: "):
                is_open.set()
                client_t_s = json.loads(line[6:]).get("client_t_s")
                # Events without figures report the connection and the alarms.
                if kind == "telemetry" and client_t_s is not None:
                    seen.live.extend((number, client_t_s, arrived_s))
    raise ConnectionError(f"the live news of {session_id} ended")


async def _view(client: AsyncClient, at: int, session_id: str, begin_s: float, seen: Seen) -> None:
    """Request the session as a page does when it opens."""
    due_s = begin_s + at * 0.618034 % 1.0 * VIEW_EVERY_S
    while True:
        await asyncio.sleep(max(0.0, due_s - time.monotonic()))
        asked_s = time.monotonic()
        try:
            response = await client.get(f"/api/sessions/{session_id}")
            response.raise_for_status()
        finally:
            # A request that is pending at the end has waited for at least this long.
            seen.views.extend((asked_s, time.monotonic() - asked_s))
        due_s += VIEW_EVERY_S


def main() -> None:
    """Read the plan from standard input and run it."""
    plan = ConsolePlan.from_json(sys.stdin.readline())
    with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
        print(json.dumps(runner.run(run(plan))), flush=True)


if __name__ == "__main__":
    main()
