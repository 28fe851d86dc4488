"""Read a server's promises from the bytes it sent: acknowledgements, welcomes, new sessions.

A promise is made when its last byte is passed to the network, whether or not it is received.
"""

import json
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field

from tests.faults.tracing.events import Event

Position = tuple[str, str, int]
"""Session, stream, epoch."""
TEXT, HEADER_END = 0x1, b"\r\n\r\n"


@dataclass(frozen=True)
class Promise:
    """The server's statement that these positions (all `seq <` the number) and sessions are stored.

    `began`: the stamp of the call that sent it. `is_ack`: an acknowledgement, not a welcome or the
    response to a request.
    """

    began: int
    began_ns: int
    is_ack: bool
    positions: Mapping[Position, int] = field(default_factory=dict)
    session_id: str = ""


def promises_of(events: Sequence[Event]) -> list[Promise]:
    """Return every promise of a trace, in the order in which they were made."""
    sent: dict[str, list[Event]] = {}
    for event in events:
        if event.what == "send" and not event.failed:
            sent.setdefault(event.path, []).append(event)
    found = [promise for sends in sent.values() for promise in _on_connection(sends)]
    return sorted(found, key=lambda promise: promise.began)


def _on_connection(sends: Sequence[Event]) -> Iterator[Promise]:
    talk = _Talk(sends)
    while (head := talk.until(HEADER_END)) is not None:
        lines = head.decode("latin-1").split("\r\n")
        status = lines[0].split(" ")[1] if lines[0].startswith("HTTP/1.1 ") else ""
        if status == "101":
            yield from _on_websocket(talk)
            return
        length = _length(lines)
        body = None if length is None else talk.take(length)
        if body is None:
            return
        if status == "201" and (session_id := _created(body)):
            yield Promise(talk.last.began, talk.last.began_ns, is_ack=False, session_id=session_id)


def _on_websocket(talk: "_Talk") -> Iterator[Promise]:
    session_id = ""
    for text in _messages(talk):
        message = json.loads(text)
        if message["type"] == "welcome":
            session_id = message["session_id"]
        if message["type"] in ("welcome", "ack"):
            positions = {
                (session_id, told["stream"], told["epoch"]): told["next_seq"]
                for told in message["positions"]
            }
            is_ack = message["type"] == "ack"
            yield Promise(talk.last.began, talk.last.began_ns, is_ack, positions, session_id)


@dataclass
class _Talk:
    """The bytes sent on a connection, in order; `last` is the call that sent the last byte read."""

    sends: Sequence[Event]
    _at: int = 0

    def __post_init__(self) -> None:
        self._bytes = b"".join(event.data for event in self.sends)
        self._ends: list[int] = []
        for event in self.sends:
            self._ends.append((self._ends[-1] if self._ends else 0) + len(event.data))

    @property
    def last(self) -> Event:
        return next(
            event for event, end in zip(self.sends, self._ends, strict=True) if end >= self._at
        )

    def until(self, mark: bytes) -> bytes | None:
        end = self._bytes.find(mark, self._at)
        return None if end < 0 else self.take(end + len(mark) - self._at)

    def take(self, length: int) -> bytes | None:
        if self._at + length > len(self._bytes):
            return None
        self._at += length
        return self._bytes[self._at - length : self._at]


def _messages(talk: _Talk) -> Iterator[bytes]:
    """Yield the text messages that a server sent over a WebSocket (RFC 6455, 5.2).

    They are neither masked nor compressed.
    """
    parts: list[bytes] = []
    kind = 0
    while (start := talk.take(2)) is not None:
        first, length = start[0], start[1] & 0x7F
        if length >= 126:
            longer = talk.take(2 if length == 126 else 8)
            if longer is None:
                return
            length = int.from_bytes(longer, "big")
        payload = talk.take(length)
        if payload is None:
            return
        if first & 0x8:
            continue
        kind = first & 0x0F or kind
        parts.append(payload)
        if first & 0x80:
            if kind == TEXT:
                yield b"".join(parts)
            parts = []


def _length(lines: Iterable[str]) -> int | None:
    for line in lines:
        name, _, value = line.partition(":")
        if name.lower() == "content-length":
            return int(value)
    return None


def _created(body: bytes) -> str:
    """Return the id of the session that a response reports as created, or "" if there is none."""
    answer = json.loads(body)
    return str(answer["id"]) if isinstance(answer, dict) and "study_version" in answer else ""
