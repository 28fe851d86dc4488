"""Simulate anonymous callers, and a bare listener: `python -m tests.benchmarks.strangers`.

Reads the plan as JSON from one line of standard input and prints `ready`. A plan with `callers`
runs that many for a given time, each as fast as it gets responses: one half tries to sign in, the
other sends bodies of 2 MB. It prints how many responses of each kind they got. A plan without
callers listens, answers 413 to every head and closes, until it is killed.
"""

import asyncio
import contextlib
import json
import secrets
import sys
import time
from collections import Counter
from dataclasses import asdict, dataclass
from typing import Any

BODY_BYTES = 2_000_000
PIECE_BYTES = 64 * 1024
PATIENCE_S = 20.0
REFUSAL = b"HTTP/1.1 413 Content Too Large\r\ncontent-length: 0\r\nconnection: close\r\n\r\n"


@dataclass(frozen=True)
class CallersPlan:
    """The number of callers that send requests to the server at `port`, and for how long."""

    port: int
    callers: int
    duration_s: float

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""
        return json.dumps(asdict(self))


@dataclass(frozen=True)
class ListenerPlan:
    """The plan of a bare listener at `port`."""

    port: int

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""
        return json.dumps(asdict(self))


async def call(port: int, callers: int, duration_s: float) -> Counter[str]:
    """Run all callers in parallel; count their responses by status, `none` for no response."""
    answers: Counter[str] = Counter()
    until_s = time.monotonic() + duration_s
    await asyncio.gather(*(_caller(port, number, until_s, answers) for number in range(callers)))
    return answers


async def _caller(port: int, number: int, until_s: float, answers: Counter[str]) -> None:
    large = number % 2 == 1
    while time.monotonic() < until_s:
        body = b"x" * BODY_BYTES if large else _credentials()
        try:
            async with asyncio.timeout(PATIENCE_S):
                answers[await _asked(port, body)] += 1
        except (TimeoutError, OSError):
            answers["none"] += 1
            # Without a pause, refused connections would be retried in a busy loop.
            await asyncio.sleep(0)


def _credentials() -> bytes:
    name = secrets.choice(("admin", f"user{secrets.randbelow(1000)}"))
    return json.dumps({"username": name, "password": secrets.token_hex(8)}).encode()


async def _asked(port: int, body: bytes) -> str:
    """Send a login with this body and return the status of the response."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    head = (
        "POST /api/login HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
        f"Content-Length: {len(body)}\r\n\r\n"
    )
    try:
        with contextlib.suppress(ConnectionError):
            writer.write(head.encode())
            for at in range(0, len(body), PIECE_BYTES):
                writer.write(body[at : at + PIECE_BYTES])
                await writer.drain()
        try:
            line = await reader.readline()
        except ConnectionError:
            return "none"
        return line[9:12].decode() or "none"
    finally:
        writer.transport.abort()


async def listen(port: int) -> None:
    """Answer 413 to every request head and close the connection."""

    async def refuse(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        with contextlib.suppress(ConnectionError, asyncio.IncompleteReadError):
            await reader.readuntil(b"\r\n\r\n")
            writer.write(REFUSAL)
        writer.close()

    server = await asyncio.start_server(refuse, "127.0.0.1", port, backlog=2048)
    print("ready", flush=True)
    await server.serve_forever()


def main(plan: dict[str, Any]) -> None:
    """Read the plan from standard input and run it."""
    if "callers" in plan:
        print("ready", flush=True)
        print(json.dumps(asyncio.run(call(**plan))), flush=True)
    else:
        asyncio.run(listen(**plan))


if __name__ == "__main__":
    main(json.loads(sys.stdin.readline()))
