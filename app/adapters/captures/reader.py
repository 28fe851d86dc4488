"""Reading a capture: bytes or a file of any known format in, a `Capture` out."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from importlib import import_module
from pathlib import Path
from typing import Protocol, cast

from app.adapters.captures.capture import Capture, CaptureError, Limits, Reading
from app.adapters.captures.sniffing import format_of, what_it_looks_like
from app.science.rig import RigError
from app.science.rotations import RotationError

_AS_IT_IS = Reading()
_LIMITS = Limits()


@dataclass(frozen=True)
class CaptureFormat:
    """A format that can be read: its key, what people call it, and how its files end."""

    key: str
    title: str
    extensions: tuple[str, ...]


FORMATS: tuple[CaptureFormat, ...] = (
    CaptureFormat("bvh", "BVH (Biovision Hierarchy)", (".bvh",)),
    CaptureFormat("motive-csv", "OptiTrack Motive CSV", (".csv",)),
    CaptureFormat("asf-amc", "Acclaim ASF and AMC", (".amc", ".asf")),
    CaptureFormat("c3d", "C3D markers", (".c3d",)),
    CaptureFormat("trc", "TRC markers", (".trc",)),
    CaptureFormat("vicon-tracker-csv", "Vicon Tracker CSV", (".csv",)),
    CaptureFormat("uxf-tracker", "UXF tracker CSV (Unity)", (".csv",)),
    CaptureFormat("quest-log", "Quest movement log", (".csv",)),
)

# Read from a module only when a file of that kind comes: a server starts without them.
_READERS = {
    "bvh": ("bvh_capture", "read_bvh_capture"),
    "motive-csv": ("motive", "read_motive"),
    "asf-amc": ("asf_amc", "read_asf_amc"),
    "c3d": ("c3d", "read_c3d"),
    "trc": ("trc", "read_trc"),
    "vicon-tracker-csv": ("vicon_tracker", "read_vicon_tracker"),
    "uxf-tracker": ("uxf_tracker", "read_uxf_tracker"),
    "quest-log": ("quest_log", "read_quest_log"),
}


class _Reader(Protocol):
    def __call__(self, data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture: ...


def read_capture(
    data: bytes, *, name: str, reading: Reading = _AS_IT_IS, limits: Limits = _LIMITS
) -> Capture:
    """Read a capture of any known format; the content decides which, the name is a hint.

    Args:
        data: the file.
        name: its name, for its extension and for names of things it does not name itself.
        reading: what the user says where the file is silent or wrong, and companion files.
        limits: how much the file may ask for.

    Returns:
        The movement in metres, y up and right-handed, with the conventions it was read by.

    Raises:
        CaptureError: the format is unknown, or the file breaks its rules: with line and reason.
    """
    if len(data) > limits.bytes:
        raise CaptureError(f"the file has {len(data)} bytes, up to {limits.bytes} are read.")
    _check_reading(reading)
    key = format_of(data, name)
    if key is None:
        valid = ", ".join(known.title for known in FORMATS)
        raise CaptureError(f"{what_it_looks_like(data)}; captures that can be read are {valid}.")
    try:
        return _reader(key)(data, name=name, reading=reading, limits=limits)
    except (RigError, RotationError) as error:
        # The body itself is impossible, which no single line is to blame for.
        raise CaptureError(str(error)) from error


def _check_reading(reading: Reading) -> None:
    scale = reading.metres_per_unit
    if scale is not None and not 1e-6 <= scale <= 1e3:
        raise CaptureError(f"{scale} m per unit: 0.000001 to 1000 is valid, such as 0.01 for cm.")


def _reader(key: str) -> _Reader:
    module, function = _READERS[key]
    reader: Callable[..., Capture] = getattr(
        import_module(f"app.adapters.captures.{module}"), function
    )
    return cast("_Reader", reader)


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
