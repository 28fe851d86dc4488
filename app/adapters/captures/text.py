"""Read the lines of a text file one at a time, in any encoding and with any line endings.

A file of a hundred megabytes is never completely in memory as text, only the current line is.
"""

import codecs
import io
import math
from collections.abc import Iterator
from itertools import islice

from app.adapters.captures.capture import CaptureError

LONGEST_LINE = 2_000_000
"""Maximum line length in characters; two thousand bodies with eight columns need a fifth."""
_BLOCK = 1 << 20


def encoding_of(data: bytes) -> str:
    """Return the encoding: UTF-8 or UTF-16 by their byte order marks, else UTF-8, else Latin-1.

    Latin-1 can decode any bytes and keeps different names different. Older exporters write the
    local code page, in which only words such as AM and PM are not ASCII.
    """
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return "utf-16"
    decoder = codecs.getincrementaldecoder("utf-8")()
    try:
        for start in range(0, len(data), _BLOCK):
            decoder.decode(data[start : start + _BLOCK])
        decoder.decode(b"", final=True)
    except UnicodeDecodeError:
        return "latin-1"
    return "utf-8-sig"


def text_lines(data: bytes, *, keep_ends: bool = False) -> Iterator[str]:
    """Yield the lines of a text file, without their endings unless `keep_ends`.

    Raises:
        CaptureError: a line is too long for a capture, or the bytes are not text.
    """
    encoding = encoding_of(data)
    stream = io.TextIOWrapper(io.BytesIO(data), encoding=encoding, newline=None)
    number = 0
    try:
        while line := stream.readline(LONGEST_LINE + 1):
            number += 1
            if len(line) > LONGEST_LINE:
                raise CaptureError(
                    f"the line is longer than {LONGEST_LINE} characters.", line=number
                )
            yield line if keep_ends else line.rstrip("\n")
    except UnicodeDecodeError:
        raise CaptureError("the text breaks off within a character.", line=number + 1) from None


def number_of(cell: str) -> float:
    """Return the number that a cell contains; NaN if it contains none.

    Python would read 8_0 as 80; no table means that.
    """
    try:
        return math.nan if "_" in cell else float(cell)
    except ValueError:
        return math.nan


def first_lines(data: bytes, count: int) -> list[str]:
    """Return the first lines, to recognise a file by; never raises, the last may be truncated."""
    start = data[: 64 * 1024]
    encoding = "utf-16" if encoding_of(start[:2]) == "utf-16" else "utf-8-sig"
    text = start.decode(encoding, errors="replace")
    return list(islice(text.splitlines(), count))
