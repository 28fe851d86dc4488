"""Captures from a folder: the file, and the one beside it that some formats need."""

from dataclasses import replace
from pathlib import Path

from app.adapters.captures.capture import Capture, CaptureError, Limits, Reading
from app.adapters.captures.door import read_capture

_AS_IT_IS = Reading()
_LIMITS = Limits()


def read_capture_file(
    path: Path, *, reading: Reading = _AS_IT_IS, limits: Limits = _LIMITS
) -> Capture:
    """Read a capture; an AMC takes its ASF from the same folder where it is clear which.

    That is the one whose name begins the AMC's, as `02.asf` does for `02_01.amc`, else the only
    one.

    Raises:
        CaptureError: see `read_capture`; also where the file is too large.
        OSError: the file cannot be opened.
    """
    if path.stat().st_size > limits.bytes:
        raise CaptureError(f"the file is larger than {limits.bytes} bytes, which is the limit.")
    if path.suffix.lower() == ".amc" and not reading.companions:
        skeleton = skeleton_beside(path)
        if skeleton is not None and skeleton.stat().st_size <= limits.bytes:
            reading = replace(reading, companions={skeleton.name: skeleton.read_bytes()})
    return read_capture(path.read_bytes(), name=path.name, reading=reading, limits=limits)


def skeleton_beside(path: Path) -> Path | None:
    """The ASF in the folder of an AMC that goes with it, if only one can be meant."""
    found = sorted(one for one in path.parent.iterdir() if one.suffix.lower() == ".asf")
    named = [one for one in found if path.stem.startswith(one.stem)]
    candidates = named or found
    return candidates[0] if len(candidates) == 1 else None
