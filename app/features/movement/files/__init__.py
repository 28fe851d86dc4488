"""Uploaded files, stored once by their content: upload, storage and download.

No file is ever completely in memory; one that is not used any more is deleted.
"""

from app.features.movement.files.contents import (
    compress,
    compressed_beside,
    drop_unused,
    plain_pieces,
    size_of,
    store,
    store_bytes,
    stored_files,
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
    "store_bytes",
    "stored_files",
    "streamed",
    "uploaded",
]
