"""Movement files of other systems: read into one form, and written from it.

`FORMATS` is the registry of what can be read, `WRITERS` of what can be written. What reads a format
is loaded when a file of that kind comes.
"""

from app.adapters.captures.bvh_export import to_bvh
from app.adapters.captures.capture import Capture, CaptureError, Limits, Reading
from app.adapters.captures.formats import FORMATS, extensions, format_texts
from app.adapters.captures.reader import read_capture, read_capture_file
from app.adapters.captures.table_export import to_csv
from app.adapters.captures.text import text_lines
from app.adapters.captures.writers import WRITERS, writer_of, writer_texts

__all__ = [
    "FORMATS",
    "WRITERS",
    "Capture",
    "CaptureError",
    "Limits",
    "Reading",
    "extensions",
    "format_texts",
    "read_capture",
    "read_capture_file",
    "text_lines",
    "to_bvh",
    "to_csv",
    "writer_of",
    "writer_texts",
]
