"""Uploaded files, kept once by their content: on their way in, stored, on their way out.

No file is ever whole in memory; one that nothing uses any more is dropped.
"""

from app.features.movement.files.contents import (
    compress,
    compressed_beside,
    drop_unused,
    plain_pieces,
    size_of,
    store,
)
from app.features.movement.files.transfer import (
    BINARY,
    BODY,
    BYTES,
    FileName,
    Uploaded,
    attachment,
    binary,
    sent,
    streamed,
    uploaded,
)

__all__ = [
    "BINARY",
    "BODY",
    "BYTES",
    "FileName",
    "Uploaded",
    "attachment",
    "binary",
    "compress",
    "compressed_beside",
    "drop_unused",
    "plain_pieces",
    "sent",
    "size_of",
    "store",
    "streamed",
    "uploaded",
]
