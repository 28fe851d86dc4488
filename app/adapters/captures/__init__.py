"""Movement files of other systems, read into one form: `read_capture` tells them apart.

What reads a format is loaded when a file of that kind comes.
"""

from app.adapters.captures.bvh_export import to_bvh
from app.adapters.captures.capture import Capture, CaptureError, Limits, Reading
from app.adapters.captures.reader import FORMATS, read_capture, read_capture_file
from app.adapters.captures.table_export import to_csv
from app.adapters.captures.text import text_lines

__all__ = [
    "FORMATS",
    "Capture",
    "CaptureError",
    "Limits",
    "Reading",
    "read_capture",
    "read_capture_file",
    "text_lines",
    "to_bvh",
    "to_csv",
]
