"""The first encoding, which is now only read: columns as byte planes, compressed.

"f32-columns-zstd/1": zstd over the concatenation of `times_s` f64[n], `flags` u8[n] and `values`
transposed to f32[w][n] with the four bytes of every float split into planes.
"""

import numpy as np
import zstandard

from app.features.record.telemetry.encodings.columns import Columns, DamagedChunkError, from_planes

NAME = "f32-columns-zstd/1"


def decode(data: bytes, frame_count: int, values_per_frame: int) -> Columns:
    """Decode a chunk; raises DamagedChunkError if zstd detects damage (there is no checksum)."""
    n, w = frame_count, values_per_frame
    expected = 9 * n + 4 * n * w
    try:
        raw = zstandard.ZstdDecompressor().decompress(data, max_output_size=expected)
    except zstandard.ZstdError as error:
        raise DamagedChunkError(f"it cannot be decompressed ({error})") from error
    if len(raw) != expected:
        raise DamagedChunkError(f"it holds {len(raw)} bytes where {n} frames need {expected}")
    columns = from_planes(np.frombuffer(raw, np.uint8, offset=9 * n), np.float32).reshape(w, n)
    return Columns(
        times_s=np.frombuffer(raw, "<f8", n, 0),
        flags=np.frombuffer(raw, np.uint8, n, 8 * n),
        values=np.ascontiguousarray(columns.T),
    )
