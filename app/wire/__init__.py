"""What travels between a headset and the server; written down in docs/protocol.md."""

from app.wire.batch import (
    BODY_JOINTS,
    HEADER_BYTES,
    VALUES_PER_FRAME,
    Batch,
    BatchHeader,
    MalformedBatchError,
    StreamName,
    decode_batch,
    decode_header,
    encode_batch,
)
from app.wire.quality import FrameFlags, flag_batches, flag_frames

__all__ = [
    "BODY_JOINTS",
    "HEADER_BYTES",
    "VALUES_PER_FRAME",
    "Batch",
    "BatchHeader",
    "FrameFlags",
    "MalformedBatchError",
    "StreamName",
    "decode_batch",
    "decode_header",
    "encode_batch",
    "flag_batches",
    "flag_frames",
]
