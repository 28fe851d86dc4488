"""A headset that needs little processor time: the protocol without a journal or retries.

Unlike `app.client`, it has neither. The load shares two cores with the server it measures. So this
client parses an acknowledgement as plain JSON, and unacknowledged messages are only in the socket's
buffer. It cannot reconnect: a broken connection is a failure of the run.
"""

import asyncio
import json
import time
from dataclasses import dataclass, field
from typing import Any, cast

from websockets.client import ClientProtocol
from websockets.frames import Frame, Opcode
from websockets.http11 import Response
from websockets.typing import Subprotocol
from websockets.uri import parse_uri

from app.wire import StreamName
from app.wire.messages import (
    PROTOCOL_VERSION,
    REPORT_STREAM,
    SUBPROTOCOL,
    HeadsetState,
    Hello,
    Probe,
    Probed,
    Produced,
    Report,
    ReportBody,
)
from tests.benchmarks.load.record import STREAMS, Record

EVERY_S = 1.0
WELCOMED_WITHIN_S = 30.0


@dataclass
class LeanHeadset(asyncio.Protocol):
    """One run of a headset; use `open` to create one."""

    record: Record
    protocol: ClientProtocol
    state: HeadsetState | None = None
    welcomed: asyncio.Future[None] = field(
        default_factory=lambda: asyncio.get_running_loop().create_future()
    )
    _transport: asyncio.Transport | None = None
    _reports: int = 0
    _began_s: float = field(default_factory=time.monotonic)
    _beside: asyncio.Task[None] | None = None
    _closing: bool = False

    @classmethod
    async def open(cls, url: str, token: str, record: Record) -> "LeanHeadset":
        """Connect and send the hello message."""
        uri = parse_uri(url)
        names = [Subprotocol(SUBPROTOCOL), Subprotocol(f"bearer.{token}")]
        made = cls(record, ClientProtocol(uri, subprotocols=names, max_size=4 * 1024 * 1024))
        loop = asyncio.get_running_loop()
        await loop.create_connection(lambda: made, uri.host, uri.port)
        await asyncio.wait_for(made.welcomed, WELCOMED_WITHIN_S)
        made._beside = asyncio.create_task(made._tell_regularly())
        return made

    @property
    def epoch(self) -> int:
        """Return the epoch, the number of this run."""
        return self.record.epoch

    async def hand(self, stream: StreamName, seq_end: int, message: bytes) -> None:
        """Send a batch of frames."""
        self.record.hand(stream.value, seq_end)
        self.protocol.send_binary(message)
        self._flush()

    async def report(self, body: ReportBody) -> None:
        """Send a report."""
        seq, self._reports = self._reports, self._reports + 1
        self.record.hand(REPORT_STREAM, seq + 1)
        self._tell(Report(epoch=self.epoch, seq=seq, body=body).model_dump_json())

    async def close(self) -> None:
        """Close the connection."""
        self._closing = True
        if self._beside is not None:
            self._beside.cancel()
        self.protocol.send_close(1000)
        self._flush()
        await asyncio.sleep(0)
        if self._transport is not None:
            self._transport.close()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Request the upgrade to a WebSocket."""
        self._transport = cast("asyncio.Transport", transport)
        self.protocol.send_request(self.protocol.connect())
        self._flush()

    def data_received(self, data: bytes) -> None:
        """Handle data from the server."""
        self.protocol.receive_data(data)
        for event in self.protocol.events_received():
            if isinstance(event, Response):
                hello = Hello(protocol=PROTOCOL_VERSION, client="lean load")
                self._tell(hello.model_dump_json())
            elif isinstance(event, Frame) and event.opcode is Opcode.TEXT:
                self._take(json.loads(bytes(event.data)))
        self._flush()

    def connection_lost(self, exc: Exception | None) -> None:
        """End the run after a broken connection, since its figures would be meaningless."""
        if not self.welcomed.done():
            self.welcomed.set_exception(ConnectionError(f"no welcome: {exc}"))
        elif not self._closing and self.record.failure is None:
            self.record.failure = f"the connection broke: {exc}"

    def _take(self, message: dict[str, Any]) -> None:
        match message["type"]:
            case "ack":
                self.record.acknowledge(
                    (one["stream"], one["epoch"], one["next_seq"]) for one in message["positions"]
                )
            case "probe":
                message.pop("type")
                received_s = time.monotonic() - self._began_s
                self._tell(Probed(**message, client_received_s=received_s).model_dump_json())
            case "state":
                self.state = HeadsetState.model_validate(message)
            case "welcome":
                self.record.epoch = message["epoch"]
                self.state = HeadsetState.model_validate(message["state"])
                self.welcomed.set_result(None)
            case "resend" | "refused" | "error" | "flag":
                self.record.failure = f"the load is not what the server expects: {message}"

    async def _tell_regularly(self) -> None:
        """Probe the clock and report the number of produced frames, once a second."""
        while True:
            self._tell(Probe(client_sent_s=time.monotonic() - self._began_s).model_dump_json())
            made = {name: self.record.streams[name].ends for name in STREAMS}
            counts = {name: ends[-1] for name, ends in made.items() if ends}
            if counts:
                produced = Produced.model_validate({"epoch": self.epoch, "streams": counts})
                self._tell(produced.model_dump_json())
            await asyncio.sleep(EVERY_S)

    def _tell(self, text: str) -> None:
        self.protocol.send_text(text.encode())
        self._flush()

    def _flush(self) -> None:
        if self._transport is not None:
            for data in self.protocol.data_to_send():
                if data:
                    self._transport.write(data)
