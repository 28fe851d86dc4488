"""What any capture file says, in one form: the movement, and which conventions it was read by."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from app.science.rig import BodyMotion, MarkerMotion, RigMotion

Origin = Literal["file", "format", "guessed", "chosen"]
"""Who says so: this file, the definition of its format, we by plausibility, or the user."""


class CaptureError(ValueError):
    """A capture file cannot be read.

    Attributes:
        line: line number from 1 of a text file, 0 where the whole file is meant or it is binary.
        reason: what is wrong there and what is valid.
    """

    def __init__(self, reason: str, *, line: int = 0) -> None:
        self.line = line
        self.reason = reason
        super().__init__(f"line {line}: {reason}" if line else reason)


@dataclass(frozen=True)
class Convention:
    """One thing that had to be known to read the file: its value, and who says so."""

    value: str
    origin: Origin


@dataclass(frozen=True)
class Conventions:
    """By which conventions a file was read; everything after is y up, right-handed, SI.

    Attributes:
        length: the file's unit, such as "cm" or "0.056444 m".
        axes: such as "y up, right-handed".
        rotations: such as "quaternion x, y, z, w", "Euler ZYX, degrees" or "none".
        rate: such as "120 Hz".
    """

    length: Convention
    axes: Convention
    rotations: Convention
    rate: Convention


@dataclass(frozen=True)
class Reading:
    """What a user says about a file where the file does not, or says it wrongly.

    Attributes:
        metres_per_unit: length of the file's unit; None to take the file's or a plausible one.
        up: the file's upward axis; None to take the file's or the format's.
        companions: other files by name, where one is not enough: an AMC needs its ASF.
    """

    metres_per_unit: float | None = None
    up: Literal["x", "y", "z"] | None = None
    companions: Mapping[str, bytes] = field(default_factory=dict)


@dataclass(frozen=True)
class Limits:
    """How much a file may ask for before it is refused; real captures stay far below."""

    bytes: int = 256_000_000
    tracks: int = 2_000
    """Joints, markers or bodies."""
    depth: int = 64
    values: int = 60_000_000
    """Numbers in memory at once, whatever a header claims."""


@dataclass(frozen=True, eq=False)
class Capture:
    """A capture as it was read.

    Attributes:
        format: key of the format, such as "bvh" or "motive-csv".
        motion: a skeleton's movement, markers, or rigid bodies.
        conventions: by which it was read.
        notes: what its reader should know, each a sentence: gaps, repairs, left-out columns.
    """

    format: str
    motion: RigMotion | MarkerMotion | BodyMotion
    conventions: Conventions
    notes: tuple[str, ...] = ()
