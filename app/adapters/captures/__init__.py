"""Read movement files of other systems into a common form, and write them.

`FORMATS` is the registry of formats that can be read, `WRITERS` of those that can be written. The
reader of a format is imported when the first file of that format is read.
"""

from app.adapters.captures.bvh_export import safe_names, to_bvh
from app.adapters.captures.capture import Capture, CaptureError, Limits, Reading
from app.adapters.captures.formats import FORMATS, extensions, format_texts
from app.adapters.captures.reader import read_capture, read_capture_file
from app.adapters.captures.table_export import to_csv
from app.adapters.captures.text import number_of, text_lines
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
    "number_of",
    "read_capture",
    "read_capture_file",
    "safe_names",
    "text_lines",
    "to_bvh",
    "to_csv",
    "writer_of",
    "writer_texts",
]
