"""Read messages of Open Sound Control 1.0 and 1.1 from a datagram.

A packet is a message (address, type tags, arguments, all padded to 4 bytes) or a bundle of sized
elements, which may be bundles. Sources: Wright, *OSC 1.0 specification*, 2002; Freed and Schmeder,
*Features and future of OSC 1.1*, NIME 2009. Our own decoder, because the library python-osc hangs
on a bundle of 28 bytes and raises half a dozen kinds of errors on others (docs/decisions).
"""

import struct
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

from app.adapters.live.readings import Problem, Refused

Argument = float | int | str | bytes | bool | None
MAX_DEPTH = 4
"""The most bundles inside each other. Trackers send one; python-osc's recursion has no limit."""
MAX_MESSAGES = 1024
"""The most messages of a packet that are read; a skeleton with a face has about 150."""
MAX_ARGUMENTS = 64
_BUNDLE = b"#bundle\0"
_HEAD = 16  # "#bundle", a zero byte, and the time tag


@dataclass(frozen=True, slots=True)
class Message:
    """A message: its address, and its arguments in order."""

    address: str
    arguments: tuple[Argument, ...]


def read_osc(packet: bytes) -> tuple[list[Message], Counter[Problem]]:
    """Return the messages of a packet in order, and the problems of the rest; never raises.

    A damaged message is left out; a damaged size ends its bundle, since what follows it cannot be
    found.
    """
    messages: list[Message] = []
    problems: Counter[Problem] = Counter()
    _element(packet, 1, messages, problems)
    return messages, problems


def _element(data: bytes, depth: int, messages: list[Message], problems: Counter[Problem]) -> None:
    try:
        if not data.startswith(_BUNDLE):
            messages.append(_message(data))
            return
        if depth > MAX_DEPTH:
            raise Refused("limit")
        at = _HEAD
        while at < len(data):
            size = _size(data, at)
            at += 4
            if size <= 0 or size % 4 or at + size > len(data):
                raise Refused("malformed")
            if len(messages) >= MAX_MESSAGES:
                raise Refused("limit")
            _element(data[at : at + size], depth + 1, messages, problems)
            at += size
        if at != len(data):
            raise Refused("malformed")
    except Refused as refused:
        problems[refused.problem] += 1


def _message(data: bytes) -> Message:
    address, at = _text(data, 0)
    if not address.startswith("/") or len(data) % 4:
        raise Refused("malformed")
    if at == len(data):  # Some old senders leave out the type tags of a message without arguments.
        return Message(address, ())
    tags, at = _text(data, at)
    if not tags.startswith(","):
        raise Refused("malformed")
    if len(tags) > MAX_ARGUMENTS:
        raise Refused("limit")
    arguments: list[Argument] = []
    for tag in tags[1:]:
        if tag in "[]":  # An array's elements are read as if they stood side by side.
            continue
        read = _READERS.get(tag)
        if read is None:
            raise Refused("malformed")
        argument, at = read(data, at)
        arguments.append(argument)
    if at != len(data):
        raise Refused("malformed")
    return Message(address, tuple(arguments))


def _number(data: bytes, at: int, layout: str) -> tuple[int | float, ...]:
    try:
        return struct.unpack_from(layout, data, at)
    except struct.error:
        raise Refused("malformed") from None


def _size(data: bytes, at: int) -> int:
    return int(_number(data, at, ">i")[0])


def _text(data: bytes, at: int) -> tuple[str, int]:
    end = data.find(b"\0", at)
    if end < 0:
        raise Refused("malformed")
    try:
        # The specification says ASCII, but trackers and bones are named in UTF-8 as well.
        return data[at:end].decode(), end + 4 - end % 4
    except UnicodeDecodeError:
        raise Refused("malformed") from None


def _blob(data: bytes, at: int) -> tuple[bytes, int]:
    size = _size(data, at)
    end = at + 4 + size
    if size < 0 or end > len(data):
        raise Refused("malformed")
    return data[at + 4 : end], end + -end % 4


def _of(layout: str) -> Callable[[bytes, int], tuple[Argument, int]]:
    size = struct.calcsize(layout)

    def read(data: bytes, at: int) -> tuple[Argument, int]:
        return _number(data, at, layout)[0], at + size

    return read


def _constant(value: Argument) -> Callable[[bytes, int], tuple[Argument, int]]:
    return lambda _, at: (value, at)


_READERS: dict[str, Callable[[bytes, int], tuple[Argument, int]]] = {
    "i": _of(">i"),
    "f": _of(">f"),
    "h": _of(">q"),
    "d": _of(">d"),
    "t": _of(">Q"),
    "r": _of(">I"),
    "m": _of(">I"),
    "c": _of(">I"),
    "s": _text,
    "S": _text,
    "b": _blob,
    "T": _constant(True),
    "F": _constant(False),
    "N": _constant(None),
    "I": _constant(float("inf")),
}
"""How the argument of each type tag is read: 1.0's required and optional ones, and 1.1's."""
