"""Reject text that cannot be stored and sent: NUL characters and lone surrogates.

PostgreSQL stores no NUL, and neither the databases nor JSON responses can encode half a surrogate
pair. Python's JSON parser accepts both, so they are rejected on input: in the head of a request
(`require_text_in_head`), and in JSON bodies and messages (`require_text_in_json`).
"""

import json
import re
from collections.abc import Iterable
from typing import Any
from urllib.parse import unquote_to_bytes

from app.errors import InvalidInput

_BAD = re.compile("[\0\ud800-\udfff]")
# An escape sequence that may encode one ("\\u0000" in JSON is a backslash and five characters).
_SUSPECT = re.compile(r"\\u(?:0000|[dD][89a-fA-F])")
_BAD_IN_HEADER = re.compile(rb"\x00|\xed[\xa0-\xbf]")


def require_text_in_head(path: bytes, query: bytes, headers: Iterable[tuple[bytes, bytes]]) -> None:
    """Raise InvalidInput if the path, the query or a header contains invalid text.

    `path` and `query` are percent-encoded, as they were sent. Headers may contain bytes other than
    UTF-8, because old clients write them in Latin-1.
    """
    for what, raw in (("path", path), ("query string", query)):
        if b"%" not in raw and raw.isascii():
            continue
        plain = unquote_to_bytes(raw)
        if b"\0" in plain or not _is_utf8(plain):
            raise _refusal(f"the {what} of the address")
    for name, value in headers:
        if _BAD_IN_HEADER.search(value):
            raise _refusal(f"the header {name.decode('latin-1')}")


def require_text_in_json(sent: bytes | str) -> None:
    """Raise InvalidInput if a JSON text or a string inside it contains invalid characters.

    Text that is not JSON is left to the parser that reads it next.
    """
    if isinstance(sent, bytes):
        try:
            sent = sent.decode()
        except UnicodeDecodeError as error:
            raise InvalidInput(
                "the request's body is not UTF-8 text",
                value=f"byte {error.start}",
                valid="JSON in UTF-8",
                remedy="Send it again in UTF-8.",
            ) from error
    if _BAD.search(sent):
        raise _refusal("the body")
    if _SUSPECT.search(sent):
        try:
            content = json.loads(sent)
        except (ValueError, RecursionError):
            return
        place = _first_bad(content)
        if place is not None:
            raise _refusal(f"the text at {place}" if place else "the text")


def printable(text: str) -> str:
    """Return the text with lone surrogates escaped, so that it can be encoded."""
    return text.encode("utf-8", "backslashreplace").decode()


def _first_bad(content: Any) -> str | None:
    """Return the path of the first string with an invalid character; None if there is none."""
    waiting: list[tuple[str, Any]] = [("", content)]
    while waiting:
        place, value = waiting.pop()
        if isinstance(value, str):
            if _BAD.search(value):
                return place
        elif isinstance(value, dict):
            for key, inner in value.items():
                if _BAD.search(key):
                    return place
                waiting.append((f"{place}.{key}"[-100:].lstrip("."), inner))
        elif isinstance(value, list):
            waiting += [(f"{place}.{at}"[-100:].lstrip("."), one) for at, one in enumerate(value)]
    return None


def _is_utf8(raw: bytes) -> bool:
    try:
        raw.decode()
    except UnicodeDecodeError:
        return False
    return True


def _refusal(where: str) -> InvalidInput:
    return InvalidInput(
        f"{where} contains a NUL character or half of a surrogate pair, which are not valid text",
        valid="Unicode text without U+0000 and U+D800 to U+DFFF",
        remedy="Leave the character out; nothing was stored.",
    )
