"""Send one JSON record per joint: `python -m tests.benchmarks.peers.json_client`.

This client works like XRXP's recorder: a queue in memory, one message per record, removed as soon
as it is sent; after a broken connection it reconnects and continues with the record that failed.
"""

import asyncio
import contextlib
import json
import sys
import time
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import uvloop
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, InvalidHandshake

from app.wire import BODY_STREAMS
from tests.benchmarks.load.movement import RATE_HZ

RETRY_S = 0.1
DRAINS_WITHIN_S = 5.0


@dataclass(frozen=True)
class JsonClientPlan:
    """The plan of a client: `records_per_s` for a duration; None: as many as the socket accepts."""

    url: str
    joints: int
    records_per_s: float | None
    duration_s: float

    def as_json(self) -> str:
        """Return the plan as one line of JSON."""
        return json.dumps(asdict(self))


@dataclass
class Sender:
    """A sender of records in order; `sent` counts those written to a socket that accepted them."""

    plan: JsonClientPlan
    sent: int = 0
    made: int = 0

    async def run(self) -> None:
        """Send until the time is over."""
        began_s = time.monotonic()
        texts = records(self.plan.joints)
        text: str | None = None
        while (passed_s := time.monotonic() - began_s) < self.plan.duration_s + DRAINS_WITHIN_S:
            try:
                async with connect(self.plan.url, compression=None) as socket:
                    while not self._is_over(began_s):
                        await self._wait_until_due(began_s)
                        text = text or next(texts)
                        await socket.send(text)
                        self.sent, text = self.sent + 1, None
                    return
            except (OSError, ConnectionClosed, InvalidHandshake):
                await asyncio.sleep(min(RETRY_S, max(0.0, self.plan.duration_s - passed_s)))

    def _is_over(self, began_s: float) -> bool:
        passed_s = time.monotonic() - began_s
        rate = self.plan.records_per_s
        if rate is None:
            return passed_s >= self.plan.duration_s
        return (
            self.sent >= rate * self.plan.duration_s
            or passed_s >= self.plan.duration_s + DRAINS_WITHIN_S
        )

    async def _wait_until_due(self, began_s: float) -> None:
        if self.plan.records_per_s is not None:
            due_s = began_s + self.sent / self.plan.records_per_s
            if (wait_s := due_s - time.monotonic()) > 0:
                await asyncio.sleep(wait_s)


def records(joints: int) -> Iterator[str]:
    """Yield the records of a session: for each frame, all joints of both streams.

    `t_s`: creation time.
    """
    seq = 0
    while True:
        for stream in BODY_STREAMS:
            for joint in range(joints):
                yield json.dumps(
                    {
                        "session": 1,
                        "stream": stream.value,
                        "joint": f"Joint{joint:02d}",
                        "seq": seq,
                        "t_s": time.monotonic(),
                        "frame_s": seq / RATE_HZ,
                        "position": {"x": 0.1234567, "y": 0.9876543, "z": -0.2345678},
                        "rotation": {
                            "w": 0.7071068,
                            "x": 0.1234567,
                            "y": 0.6543211,
                            "z": -0.2345678,
                        },
                    }
                )
        seq += 1


async def run(plan: JsonClientPlan) -> dict[str, Any]:
    """Run the sender and return the number of sent records."""
    sender = Sender(plan)
    with contextlib.suppress(asyncio.CancelledError):
        await sender.run()
    return {"sent": sender.sent}


def main() -> None:
    """Read the plan from standard input and run it."""
    plan = JsonClientPlan(**json.loads(sys.stdin.readline()))
    with asyncio.Runner(loop_factory=uvloop.new_event_loop) as runner:
        print(json.dumps(runner.run(run(plan))), flush=True)


if __name__ == "__main__":
    main()
