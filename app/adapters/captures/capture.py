"""The common form of all captures: the movement, and the conventions by which it was read."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from app.science.anatomy import Notice
from app.science.rig import BodyMotion, MarkerMotion, RigMotion

Origin = Literal["file", "format", "guessed", "chosen"]
"""Origin of a convention: the file, its format's definition, our guess, or the user's choice."""


class CaptureError(ValueError):
    """A capture file cannot be read.

    Attributes:
        line: line number from 1 of a text file; 0 for the whole file, or a binary file.
        reason: what is wrong and what is valid.
    """

    def __init__(self, reason: str, *, line: int = 0) -> None:
        self.line = line
        self.reason = reason
        super().__init__(f"line {line}: {reason}" if line else reason)


@dataclass(frozen=True)
class Convention:
    """One convention used to read the file: its value and its origin."""

    value: str
    origin: Origin


@dataclass(frozen=True)
class Conventions:
    """The conventions by which a file was read; the result is y up, right-handed, in SI units.

    Attributes:
        length: the file's unit, such as "cm" or "0.056444 m".
        axes: the axes, such as "y up, right-handed".
        rotations: the form of rotations, such as "quaternion x, y, z, w", "Euler ZYX, degrees" or
            "none".
        rate: the sampling rate, such as "120 Hz".
    """

    length: Convention
    axes: Convention
    rotations: Convention
    rate: Convention


@dataclass(frozen=True)
class Reading:
    """A user's instructions for reading a file whose own information is missing or wrong.

    Attributes:
        metres_per_unit: length of the file's unit; None to use the file's or a plausible one.
        up: the file's upward axis; None to use the file's or the format's.
        companions: other required files by name: an AMC needs its ASF.
    """

    metres_per_unit: float | None = None
    up: Literal["x", "y", "z"] | None = None
    companions: Mapping[str, bytes] = field(default_factory=dict)


@dataclass(frozen=True)
class Limits:
    """The largest sizes of a file that are accepted; real captures stay far below."""

    bytes: int = 256_000_000
    tracks: int = 2_000
    """Largest number of joints, markers or bodies."""
    depth: int = 64
    values: int = 60_000_000
    """Maximum number of values in memory, whatever a header claims."""


@dataclass(frozen=True, eq=False)
class Capture:
    """A capture as it was read.

    Attributes:
        format: key of the format, such as "bvh" or "motive-csv".
        motion: a skeleton's movement, markers, or rigid bodies.
        conventions: the conventions by which it was read.
        notes: sentences that users should know: gaps, repairs, omitted columns.
        notices: what the size of the body had to decide, because the file does not say it.
    """

    format: str
    motion: RigMotion | MarkerMotion | BodyMotion
    conventions: Conventions
    notes: tuple[str, ...] = ()
    notices: tuple[Notice, ...] = ()
