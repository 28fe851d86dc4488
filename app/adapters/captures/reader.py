"""Read a capture of any known format, from bytes or a file, into a `Capture`."""

from dataclasses import replace
from pathlib import Path

from app.adapters.captures.capture import Capture, CaptureError, Limits, Reading
from app.adapters.captures.formats import FORMATS, format_of
from app.adapters.captures.sniffing import describe_unknown_file
from app.science.rig import RigError
from app.science.rotations import RotationError

_AS_IT_IS = Reading()
_LIMITS = Limits()


def read_capture(
    data: bytes, *, name: str, reading: Reading = _AS_IT_IS, limits: Limits = _LIMITS
) -> Capture:
    """Read a capture of any known format, determined by its content; the name is only a hint.

    Args:
        data: the content of the file.
        name: the name of the file, used for its extension and to name things that the file leaves
            unnamed.
        reading: the user's instructions where the file's own information is missing or wrong, and
            companion files.
        limits: the largest sizes that are accepted.

    Returns:
        The movement in metres, y up and right-handed, with the conventions by which it was read.

    Raises:
        CaptureError: the format is unknown, or the file violates its rules; the error gives the
            line and the reason.
    """
    if len(data) > limits.bytes:
        raise CaptureError(f"the file has {len(data)} bytes, up to {limits.bytes} are read.")
    _check_reading(reading)
    found = format_of(data, name)
    if found is None:
        valid = ", ".join(one.title for one in FORMATS)
        raise CaptureError(f"{describe_unknown_file(data)}; captures that can be read are {valid}.")
    try:
        return found.load_reader()(data, name=name, reading=reading, limits=limits)
    except (RigError, RotationError) as error:
        # The body itself is impossible; no single line is at fault.
        raise CaptureError(str(error)) from error


def _check_reading(reading: Reading) -> None:
    scale = reading.metres_per_unit
    if scale is not None and not 1e-6 <= scale <= 1e3:
        raise CaptureError(f"{scale} m per unit: 0.000001 to 1000 is valid, such as 0.01 for cm.")


def read_capture_file(
    path: Path, *, reading: Reading = _AS_IT_IS, limits: Limits = _LIMITS
) -> Capture:
    """Read a capture; the ASF of an AMC is taken from the same folder if it is unambiguous.

    It is the one whose name begins the AMC's, as `02.asf` does for `02_01.amc`, or else the only
    one.

    Raises:
        CaptureError: see `read_capture`; also if the file is too large.
        OSError: the file cannot be opened.
    """
    if path.stat().st_size > limits.bytes:
        raise CaptureError(f"the file is larger than {limits.bytes} bytes, which is the limit.")
    if path.suffix.lower() == ".amc" and not reading.companions:
        skeleton = companion_skeleton(path)
        if skeleton is not None and skeleton.stat().st_size <= limits.bytes:
            reading = replace(reading, companions={skeleton.name: skeleton.read_bytes()})
    return read_capture(path.read_bytes(), name=path.name, reading=reading, limits=limits)


def companion_skeleton(path: Path) -> Path | None:
    """Return the ASF in the folder of an AMC that belongs to it, if it is unambiguous."""
    found = sorted(one for one in path.parent.iterdir() if one.suffix.lower() == ".asf")
    named = [one for one in found if path.stem.startswith(one.stem)]
    candidates = named or found
    return candidates[0] if len(candidates) == 1 else None
