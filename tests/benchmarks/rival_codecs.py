"""Chunk encodings that need other libraries; only those that are installed are measured.

To install them: `uv pip install pcodec pyarrow blosc2` into the environment; none of them is needed
otherwise.
"""

import importlib
from typing import Any

import numpy as np
from numpy.typing import NDArray

from app.features.record.telemetry.encodings.columns import Columns
from app.features.record.telemetry.encodings.integers import best_differences, pack, summed, unpack
from app.features.record.telemetry.encodings.significands import (
    Significands,
    cut,
    joined,
    rest_widths,
)
from app.features.record.telemetry.encodings.unit_quaternions import LeftOut, choose
from tests.benchmarks.codecs import Codec, bits_of, values_of

_GROUPS = 6


def rival_codecs() -> tuple[list[Codec], list[str]]:
    """Return the available codecs, and the libraries that are missing."""
    found: list[Codec] = []
    absent = []
    for library, make in (("pcodec", _pcodec), ("pyarrow", _arrow), ("blosc2", _blosc)):
        try:
            importlib.import_module(library)
        except ImportError:
            absent.append(library)
        else:
            found += make()
    return found, absent


def _framed(*parts: bytes) -> bytes:
    """Concatenate parts, each preceded by its length."""
    return b"".join(len(part).to_bytes(4, "little") + part for part in parts)


def _unframed(data: bytes) -> list[bytes]:
    parts, at = [], 0
    while at < len(data):
        end = at + 4 + int.from_bytes(data[at : at + 4], "little")
        parts.append(data[at + 4 : end])
        at = end
    return parts


class _Pcodec:
    """An encoding in pcodec's own file format, for numbers of any shape."""

    def __init__(self) -> None:
        library = importlib.import_module("pcodec")
        self._files: Any = importlib.import_module("pcodec.standalone")
        self.automatic: Any = library.ChunkConfig()
        self.settled: Any = library.ChunkConfig(
            delta_spec=library.DeltaSpec.no_op(), mode_spec=library.ModeSpec.classic()
        )

    def squeeze(self, numbers: NDArray[Any], config: Any) -> bytes:
        """Compress numbers to the contents of a file."""
        return bytes(self._files.simple_compress(np.ascontiguousarray(numbers).ravel(), config))

    def expand(self, data: bytes, number: type[Any]) -> NDArray[Any]:
        """Return the numbers of a compressed file as a flat array."""
        numbers = self._files.simple_decompress(data)
        return np.asarray([] if numbers is None else numbers, number)


def _pcodec() -> list[Codec]:
    pco = _Pcodec()

    def encode(columns: Columns) -> bytes:
        rows = np.ascontiguousarray(columns.values.T)
        return _framed(
            pco.squeeze(columns.times_s, pco.automatic),
            columns.flags.tobytes(),
            pco.squeeze(rows, pco.automatic),
        )

    def decode(data: bytes, n: int, w: int) -> Columns:
        times, flags, values = _unframed(data)
        rows = pco.expand(values, np.float32).reshape(w, n)
        return Columns(
            pco.expand(times, np.float64),
            np.frombuffer(flags, np.uint8),
            np.ascontiguousarray(rows.T),
        )

    return [
        Codec("pcodec on columns of floats", encode, decode),
        Codec("our prediction, pcodec behind it", *_predicted(pco)),
    ]


def _predicted(pco: _Pcodec) -> tuple[Any, Any]:
    """Apply steps 1 to 3 of f32-predicted-zstd, with pcodec in place of noise bits and zstd."""

    def encode(columns: Columns) -> bytes:
        bits = bits_of(columns)
        left_out = choose(bits)
        kept = bits[left_out.kept_rows]
        floats = cut(kept)
        unforeseen = (bits[left_out.rows] - left_out.expected(kept)).view(np.int32)
        order, differences = best_differences(np.concatenate((floats.coarse, unforeseen)))
        # Rows of similar magnitude share their bins.
        by_size = differences.mean(axis=1).argsort().astype(np.uint8)
        return _framed(
            pco.squeeze(columns.times_s, pco.automatic),
            columns.flags.tobytes(),
            left_out.as_bytes() + floats.top.tobytes() + order.tobytes() + by_size.tobytes(),
            pco.squeeze(floats.exceptions, pco.settled),
            pack(floats.rest.ravel(), floats.rest_widths.ravel()),
            *(
                pco.squeeze(group, pco.settled)
                for group in np.array_split(differences[by_size], _GROUPS)
            ),
        )

    def decode(data: bytes, n: int, w: int) -> Columns:
        times, flags, small, exceptions, rest, *groups = _unframed(data)
        joints = (w - 3) // 4
        which, top, order, by_size = np.split(
            np.frombuffer(small, np.uint8), np.cumsum([joints, w - joints, w])
        )
        differences = np.empty((w, n), np.uint32)
        sizes = [pco.expand(group, np.uint32) for group in groups]
        differences[by_size] = np.concatenate(sizes).reshape(w, n)
        rows = summed(order, differences)
        coarse, left_out = rows[: w - joints], LeftOut.of_bytes(which, w % 4)
        widths = rest_widths(coarse)
        rests = unpack(rest, widths.ravel()).reshape(coarse.shape)
        kept = joined(Significands(top, coarse, rests, widths, pco.expand(exceptions, np.uint32)))
        bits = np.empty((w, n), np.uint32)
        bits[left_out.kept_rows] = kept
        bits[left_out.rows] = rows[w - joints :].view(np.uint32) + left_out.expected(kept)
        return Columns(
            pco.expand(times, np.float64), np.frombuffer(flags, np.uint8), values_of(bits)
        )

    return encode, decode


def _arrow() -> list[Codec]:
    return [
        _arrow_with("zstd", by_column=True),
        _arrow_with("zstd", by_column=False),
        _arrow_with("lz4", by_column=False),
    ]


def _arrow_with(compression: str, *, by_column: bool) -> Codec:
    """Return a codec for Arrow's stream format, with one column per value or one list per frame."""
    arrow: Any = importlib.import_module("pyarrow")
    ipc: Any = importlib.import_module("pyarrow.ipc")
    options = ipc.IpcWriteOptions(compression=compression, use_threads=False)

    def encode(columns: Columns) -> bytes:
        values = columns.values
        if by_column:
            arrays = [arrow.array(row) for row in np.ascontiguousarray(values.T)]
        else:
            flat = arrow.array(values.ravel())
            arrays = [arrow.FixedSizeListArray.from_arrays(flat, values.shape[1])]
        arrays = [arrow.array(columns.times_s), arrow.array(columns.flags), *arrays]
        names = [str(at) for at in range(len(arrays))]
        batch = arrow.RecordBatch.from_arrays(arrays, names)
        sink = arrow.BufferOutputStream()
        with ipc.new_stream(sink, batch.schema, options=options) as writer:
            writer.write_batch(batch)
        return bytes(sink.getvalue())

    def decode(data: bytes, n: int, w: int) -> Columns:
        (batch,) = ipc.open_stream(data)
        times, flags, *rows = batch.columns
        if by_column:
            values = np.stack([row.to_numpy() for row in rows], axis=1)
        else:
            values = rows[0].flatten().to_numpy().reshape(n, w)
        return Columns(times.to_numpy(), flags.to_numpy(), values)

    layout = "a column per value" if by_column else "a list per frame"
    return Codec(f"Arrow stream, {layout}, {compression}", encode, decode)


def _blosc() -> list[Codec]:
    return [_blosc_with("BITSHUFFLE"), _blosc_with("SHUFFLE", "BYTEDELTA")]


def _blosc_with(*filters: str) -> Codec:
    """Encode the columns with blosc2's filters and its zstd."""
    blosc: Any = importlib.import_module("blosc2")
    settings = {
        "codec": blosc.Codec.ZSTD,
        "clevel": 5,
        "typesize": 4,
        "nthreads": 1,
        "filters": [getattr(blosc.Filter, name) for name in filters],
        "filters_meta": [4 if name == "BYTEDELTA" else 0 for name in filters],
    }

    def encode(columns: Columns) -> bytes:
        values = blosc.compress2(np.ascontiguousarray(columns.values.T), **settings)
        return _framed(columns.times_s.tobytes(), columns.flags.tobytes(), values)

    def decode(data: bytes, n: int, w: int) -> Columns:
        times, flags, values = _unframed(data)
        rows = np.frombuffer(blosc.decompress2(values), np.float32).reshape(w, n)
        return Columns(
            np.frombuffer(times), np.frombuffer(flags, np.uint8), np.ascontiguousarray(rows.T)
        )

    name = " + ".join(one.lower() for one in filters)
    return Codec(f"blosc2, {name}, zstd 5", encode, decode)
