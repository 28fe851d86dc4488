"""Movement files of other systems, read into one form: `read_capture` tells them apart."""

from app.adapters.captures.bvh_export import to_bvh
from app.adapters.captures.capture import (
    Capture,
    CaptureError,
    Convention,
    Conventions,
    Limits,
    Reading,
)
from app.adapters.captures.door import FORMATS, CaptureFormat, read_capture
from app.adapters.captures.table_export import to_csv

__all__ = [
    "FORMATS",
    "Capture",
    "CaptureError",
    "CaptureFormat",
    "Convention",
    "Conventions",
    "Limits",
    "Reading",
    "read_capture",
    "to_bvh",
    "to_csv",
]
