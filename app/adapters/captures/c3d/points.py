"""Locate and decode the points of a C3D file.

A frame contains x, y, z and a fourth word for each point, then the analogue samples. With a
positive scale all are 16-bit integers and a coordinate is the scale times the integer; with a
negative one they are 4-byte real numbers, already scaled. The fourth word is negative if the point
was not visible.
"""

import struct
from dataclasses import dataclass

import numpy as np

from app.adapters.captures.c3d.parameters import BLOCK, Parameters, Processor, vax_reals
from app.adapters.captures.capture import CaptureError, Limits
from app.science.rotations import FloatArray


@dataclass(frozen=True)
class Layout:
    """The location and format of the frames; bytes count from the start of the file."""

    processor: Processor
    points: int
    frames: int
    scale: float
    start: int
    frame_bytes: int
    rate_hz: float
    notes: tuple[str, ...] = ()

    @property
    def real(self) -> bool:
        """Whether the numbers are 4-byte reals."""
        return self.scale < 0.0


def layout(data: bytes, parameters: Parameters, limits: Limits) -> Layout:
    """Determine where the frames are, and check that the file contains them.

    Raises:
        CaptureError: header and parameters describe no frames, or more than the file contains.
    """
    processor = parameters.processor
    points, analogue, first, last, _ = struct.unpack_from(f"{processor.order}5H", data, 2)
    scale = float(processor.reals(data[12:16])[0])
    block = struct.unpack_from(f"{processor.order}H", data, 16)[0] or int(
        parameters.number("POINT", "DATA_START") or 0
    )
    rate = parameters.number("POINT", "RATE") or float(processor.reals(data[20:24])[0])
    if not np.isfinite(scale) or scale == 0.0:
        raise CaptureError(f"the header's scale is {scale}: the file is damaged.")
    if not 1 <= points <= limits.tracks:
        raise CaptureError(f"the header declares {points} markers: 1 to {limits.tracks} are valid.")
    start = (block - 1) * BLOCK
    frame_bytes = (4 * points + analogue) * (4 if scale < 0.0 else 2)
    if not BLOCK <= start < len(data):
        raise CaptureError(f"the frames should begin at byte {start} of {len(data)}: damaged.")
    frames, notes = _frames(parameters, first, last, (len(data) - start) // frame_bytes)
    if frames * points * 4 > limits.values:
        raise CaptureError(f"{frames} frames of {points} markers are too many to read.")
    return Layout(processor, points, frames, scale, start, frame_bytes, rate, notes)


def _frames(
    parameters: Parameters, first: int, last: int, present: int
) -> tuple[int, tuple[str, ...]]:
    """Return the number of frames, and notes if the file is inconsistent.

    Several fields state it, because 16 bits are too few for long captures.
    """
    stated = [
        _trial_frames(parameters),
        int(parameters.number("POINT", "LONG_FRAMES") or 0),
        int(parameters.number("POINT", "FRAMES") or 0) % 65536,
        last - first + 1,
    ]
    claims = [frames for frames in stated if frames > 0]
    fitting = [frames for frames in claims if frames <= present]
    if not fitting:
        claim = f"{claims[0]} frames" if claims else "no frames"
        raise CaptureError(
            f"the file declares {claim} but contains {present}: it is truncated or damaged."
        )
    if len(set(claims)) == 1:
        return fitting[0], ()
    listed = ", ".join(str(frames) for frames in claims)
    note = (
        f"The file states its number of frames differently in several places ({listed});"
        f" {fitting[0]} were read."
    )
    return fitting[0], (note,)


def _trial_frames(parameters: Parameters) -> int:
    """Return the number of frames by TRIAL:ACTUAL_START_FIELD and ACTUAL_END_FIELD, or 0.

    Each is a 32-bit number as two 16-bit halves.
    """
    ends = []
    for name in ("ACTUAL_START_FIELD", "ACTUAL_END_FIELD"):
        halves = [int(half) % 65536 for half in parameters.numbers("TRIAL", name)]
        if len(halves) != 2:
            return 0
        ends.append(halves[0] + 65536 * halves[1])
    return ends[1] - ends[0] + 1


def read_points(data: bytes, at: Layout, kept: list[int]) -> FloatArray:
    """Return the selected points (N, M, 3) in the file's unit, NaN where one was not visible."""
    shape, word = (at.frames, at.points, 4), 4 if at.real else 2
    if at.real and at.processor.vax:
        halves: np.ndarray[tuple[int, ...], np.dtype[np.uint16]] = np.ndarray(
            (*shape, 2), "<u2", data, at.start, (at.frame_bytes, 4 * word, word, 2)
        )
        raw = vax_reals(halves[:, kept]).astype(np.float64)
    else:
        kind = f"{at.processor.order}{'f4' if at.real else 'i2'}"
        table: np.ndarray[tuple[int, ...], np.dtype[np.float64]] = np.ndarray(
            shape, kind, data, at.start, (at.frame_bytes, 4 * word, word)
        )
        with np.errstate(invalid="ignore"):
            raw = table[:, kept].astype(np.float64)
    places: FloatArray = raw[..., :3] if at.real else raw[..., :3] * at.scale
    # Some programs leave the fourth word at zero and place invisible markers exactly at the origin.
    unseen = ~(raw[..., 3] >= 0.0) | ~np.isfinite(places).all(-1) | (places == 0.0).all(-1)
    places[unseen] = np.nan
    return places
