"""Read an AMC and its ASF as the movement of a skeleton."""

from pathlib import PurePosixPath

from app.adapters.captures.asf_amc.bones import read_asf
from app.adapters.captures.asf_amc.movement import Rows, read_amc, root_positions, rotations_of
from app.adapters.captures.asf_amc.skeleton import Acclaim
from app.adapters.captures.axes import turned_rig_motion
from app.adapters.captures.capture import (
    Capture,
    CaptureError,
    Convention,
    Conventions,
    Limits,
    Reading,
)
from app.adapters.captures.text import first_lines
from app.science.rig import RigMotion

RATE_HZ = 120.0
"""AMC specifies no frame rate; this is that of the CMU captures, the source of nearly all AMCs."""
_ASF_SECTIONS = (":version", ":name", ":units", ":documentation", ":root", ":bonedata")


def read_asf_amc(data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture:
    """Read an AMC; its skeleton is the companion file whose name ends in .asf.

    Args:
        data: the content of the AMC file.
        name: the name of the AMC file, such as "02_01.amc", for messages.
        reading: `companions` must contain the ASF; a unit or upward axis overrides the file's.
        limits: the largest sizes that are accepted.

    Returns:
        The movement of a rig whose joints are where the bones begin (see `skeleton`).

    Raises:
        CaptureError: the ASF is missing, `data` is itself one, or either cannot be read.
    """
    if _is_skeleton(data):
        raise CaptureError(
            f"{name} is an ASF, a skeleton without movement: give an AMC made with it, such as"
            f" {PurePosixPath(name).stem}_01.amc, and this file as its companion."
        )
    companion, skeleton = _skeleton(data, name, reading, limits)
    rows = read_amc(data, skeleton, limits)
    metres = reading.metres_per_unit or skeleton.metres_per_unit
    motion = _motion(skeleton, rows, metres)
    unseen = int((~motion.observed).sum())
    return Capture(
        format="asf-amc",
        motion=turned_rig_motion(motion, reading.up or "y"),
        conventions=_conventions(rows, metres, reading),
        notes=(
            f"The skeleton is {companion}.",
            f"AMC names no rate: {RATE_HZ:g} Hz is that of most CMU captures.",
            *((f"{unseen} rows are missing and were carried over.",) if unseen else ()),
        ),
    )


def _skeleton(data: bytes, name: str, reading: Reading, limits: Limits) -> tuple[str, Acclaim]:
    companion, asf = _skeleton_file(name, reading)
    for file, content in ((name, data), (companion, asf)):
        if len(content) > limits.bytes:
            raise CaptureError(
                f"{file} has {len(content)} bytes: at most {limits.bytes} are valid."
            )
    try:
        return companion, read_asf(asf, limits)
    except CaptureError as error:
        raise CaptureError(f"in {companion}: {error.reason}", line=error.line) from error


def _motion(skeleton: Acclaim, rows: Rows, metres: float) -> RigMotion:
    rotations, observed = rotations_of(skeleton, rows)
    return RigMotion(
        rig=skeleton.rig(metres),
        rate_hz=RATE_HZ,
        root_positions_m=root_positions(skeleton, rows) * metres,
        rotations=rotations,
        observed=observed,
    )


def _conventions(rows: Rows, metres: float, reading: Reading) -> Conventions:
    unit = "degrees" if rows.degrees else "radians"
    return Conventions(
        length=Convention(f"{metres:.6g} m", "chosen" if reading.metres_per_unit else "format"),
        axes=Convention(
            f"{reading.up or 'y'} up, right-handed", "chosen" if reading.up else "format"
        ),
        rotations=Convention(f"Euler about each bone's own axis, {unit}", "file"),
        rate=Convention(f"{RATE_HZ:g} Hz", "guessed"),
    )


def _is_skeleton(data: bytes) -> bool:
    words = (line.split(maxsplit=1) for line in first_lines(data, 200))
    return any(found and found[0].lower() in _ASF_SECTIONS for found in words)


def _skeleton_file(name: str, reading: Reading) -> tuple[str, bytes]:
    found = sorted(other for other in reading.companions if other.lower().endswith(".asf"))
    if len(found) == 1:
        return found[0], reading.companions[found[0]]
    subject = PurePosixPath(name).stem.split("_")[0]
    for other in found:
        if PurePosixPath(other).stem.lower() == subject.lower():
            return other, reading.companions[other]
    if found:
        raise CaptureError(
            f"{len(found)} skeletons came with {name} ({', '.join(found[:5])}) and none is called"
            f" {subject}.asf: give the one it was made with."
        )
    raise CaptureError(
        f"{name} contains rotations only; their bones are in the ASF of the same person: give"
        f" {subject}.asf with it."
    )
