"""A test of the ZIP file of an export."""

import io
import zipfile
import zlib

import numpy as np

from app.features.results.exports.writing.archive import LEVEL, zip_pieces
from app.features.results.exports.writing.contents import Member
from tests.features.builders import NOW


def test_files_are_compressed_at_the_quickest_level() -> None:
    """A file of numbers is as long in the archive as zlib's lowest level makes it."""
    numbers = np.random.default_rng(1).normal(size=(2000, 8)).astype(np.float32)
    text = "\n".join(",".join(map(str, row)) for row in numbers.tolist()).encode()
    packed = b"".join(zip_pieces([Member("samples/one.csv", iter([text]))], NOW))
    deflate = zlib.compressobj(LEVEL, zlib.DEFLATED, -zlib.MAX_WBITS)
    with zipfile.ZipFile(io.BytesIO(packed)) as archive:
        entry = archive.getinfo("samples/one.csv")
        assert archive.read(entry) == text
    assert entry.date_time == NOW.timetuple()[:6]
    assert entry.compress_size == len(deflate.compress(text)) + len(deflate.flush())
