"""Compute the movement of a phase as bytes that a page can draw.

  bytes 0-3    length L of the header, unsigned, little-endian
  bytes 4-     header: JSON in UTF-8, padded with spaces so that 4 + L is a multiple of 4
  then         float32, little-endian: x, y, z in m of every joint, [body][frame][joint][axis]
  then         float32: joint errors in radians, [frame][joint]
  then         int16, only on request: 32767 times w, x, y, z of every joint's rotation in its
               parent's frame, [body][frame][joint][wxyz]; zeros where it is unknown
  then         int16, if these were asked for and fingers were recorded: the same of every finger
               part, [body][frame][part][wxyz]

The header has `names` and `parents` of the J joints, `bodies` ("target", the participant, and
"actual", the avatar), the number of `frames` N and their `rate_hz`, from the phase's time 0,
`error_joints`, `error_frames` and `error_rate_hz`, and `gaps`: spans (begin, end) of the phase's
time in which nothing was recorded. `rotations` is true if they follow. `finger_parts`
names the parts of fingers if those follow, too.

Positions are computed by forward kinematics from the stored frame nearest to each moment, without
smoothing or interpolation. In gaps, and for invalid rotations, they are NaN. Errors are the angles
between the avatar's target pose at that moment and its actual pose (`app.science.joint_error`).
Pieces of a second are read one after the other, so a long phase takes no more memory than its
answer.
"""

import json
import struct
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from sqlalchemy.orm import Session

from app.database import Database
from app.features.record.telemetry import Frames, epochs_of, hinges_of, iter_frames
from app.features.results.replay.errors import RunErrors, no_errors
from app.features.results.replay.grid import Grid, Sampling, uncovered
from app.features.results.replay.service import body_of
from app.features.results.replay.times import phase_clock
from app.models import Phase
from app.platform.access import session_by_id
from app.science.avatar.targets import HingeReference
from app.science.joint_error import ERROR_JOINTS
from app.science.rotations import is_unit
from app.science.skeleton import (
    FINGER_COUNT,
    FINGER_PARTS,
    JOINT_COUNT,
    JOINT_NAMES,
    PARENTS,
    Skeleton,
    forward_kinematics,
)
from app.wire import BODY_STREAMS, FINGER_STREAMS, StreamName

MAX_HZ = 30.0
ERROR_HZ = 10.0
MAX_NUMBERS = 4_000_000
"""16 MB: a quarter of an hour of two bodies at 30 Hz; longer phases have a lower rate."""
ROTATION_SCALE = 32767.0
"""What stored components of rotations are multiplied by: they are exact to 0.004 degrees."""
Places = NDArray[np.float32]
Rotations = NDArray[np.int16]
_FINGERS_OF = dict(zip(BODY_STREAMS, FINGER_STREAMS, strict=True))


@dataclass(frozen=True)
class Recording:
    """The frames of a phase to read, and the skeleton to compute positions with.

    `offsets_s`: by epoch, the difference from the run's clock to the phase's time. `full`: with the
    avatar and its errors. `hinges`: those of a physics avatar. `rotations`: with those of the
    joints, for bodies with skin.
    """

    session_id: str
    phase_id: int
    offsets_s: Mapping[int, float]
    duration_s: float
    skeleton: Skeleton
    full: bool = True
    hinges: HingeReference | None = None
    rotations: bool = False


@dataclass
class Movement:
    """The positions, errors and gaps of a phase.

    Attributes:
        positions_m: By body, (N, 22, 3).
        errors_rad: (M, 21); no rows if there is only one body.
        gaps: Spans of the phase's time without a frame of the participant.
        rotations: By body, (N, 22, 4) local rotations times `ROTATION_SCALE`; empty unless asked.
        fingers: By body, the same of its fingers (N, 30, 4); empty if none were recorded.
    """

    grid: Grid
    error_grid: Grid
    positions_m: dict[StreamName, Places]
    errors_rad: NDArray[np.float32]
    gaps: list[tuple[float, float]] = field(default_factory=list)
    rotations: dict[StreamName, Rotations] = field(default_factory=dict)
    fingers: dict[StreamName, Rotations] = field(default_factory=dict)


def movement_of(db: Session, recording: Recording) -> Movement:
    """Read a phase's frames and compute the positions of its bodies."""
    bodies = 2 if recording.full else 1
    fingers = recording.rotations and _has_fingers(db, recording)
    rate_hz = _rate_hz(recording, bodies, FINGER_COUNT if fingers else 0)
    grid = Grid.over(recording.duration_s, rate_hz)
    error_grid = Grid.over(recording.duration_s, ERROR_HZ if recording.full else 0.0)
    movement = Movement(grid, error_grid, {}, no_errors(error_grid))
    tracks = {
        epoch: RunErrors(Sampling(error_grid, offset_s))
        for epoch, offset_s in recording.offsets_s.items()
    }
    if recording.full:
        # The avatar first: its frames decide which frames of the participant are needed.
        _fill(db, recording, StreamName.ACTUAL, movement, tracks)
    movement.gaps = _fill(db, recording, StreamName.TARGET, movement, tracks)
    if recording.full:
        for track in tracks.values():
            track.fill(movement.errors_rad, recording.hinges)
    else:
        movement.errors_rad = movement.errors_rad[:0]
    if fingers:
        movement.fingers = {
            body: _fingers(db, recording, _FINGERS_OF[body], grid) for body in movement.positions_m
        }
    return movement


def _has_fingers(db: Session, recording: Recording) -> bool:
    return any(epochs_of(db, recording.session_id, stream) for stream in FINGER_STREAMS)


def _fingers(db: Session, recording: Recording, stream: StreamName, grid: Grid) -> Rotations:
    """Return the rotations of a body's fingers at the grid's moments, zeros where unknown."""
    turns = np.zeros((grid.count, FINGER_COUNT, 4), np.int16)
    for epoch, offset_s in recording.offsets_s.items():
        sampling = Sampling(grid, offset_s)
        for piece in _pieces(db, recording, stream, epoch):
            at, frames = sampling.take(piece)
            if len(at):
                turns[at] = _in_16_bits(frames)
    return turns


def _fill(
    db: Session,
    recording: Recording,
    stream: StreamName,
    movement: Movement,
    tracks: Mapping[int, RunErrors],
) -> list[tuple[float, float]]:
    """Add one body to the movement; return the gaps of its stream."""
    grid = movement.grid
    places = np.full((grid.count, JOINT_COUNT, 3), np.nan, np.float32)
    turns = np.zeros((grid.count if recording.rotations else 0, JOINT_COUNT, 4), np.int16)
    runs = []
    for epoch, offset_s in recording.offsets_s.items():
        sampling = Sampling(grid, offset_s)
        for piece in _pieces(db, recording, stream, epoch):
            at, frames = sampling.take(piece)
            if len(at):
                places[at] = _placed(recording.skeleton, frames)
                if recording.rotations:
                    turns[at] = _in_16_bits(frames)
            track = tracks[epoch]
            track.actual(piece) if stream is StreamName.ACTUAL else track.target(piece)
        runs.append(sampling)
    movement.positions_m[stream] = places
    if recording.rotations:
        movement.rotations[stream] = turns
    return uncovered(runs, recording.duration_s)


def _pieces(db: Session, recording: Recording, stream: StreamName, epoch: int) -> Iterator[Frames]:
    of_phase = iter_frames(db, recording.session_id, stream, epoch, recording.phase_id)
    return (frames for _, frames in of_phase)


def _placed(skeleton: Skeleton, frames: Frames) -> Places:
    """Return joint positions in the world (n, 22, 3), NaN below an invalid rotation."""
    rotations = frames.rotations
    usable = np.where(is_unit(rotations)[..., np.newaxis], rotations, np.nan)
    roots_m = frames.values[:, :3].astype(np.float64)
    return forward_kinematics(skeleton, roots_m, usable).positions_m.astype(np.float32)


def _in_16_bits(frames: Frames) -> Rotations:
    """Return local rotations (n, 22 or 30, 4) times `ROTATION_SCALE`, zeros for an invalid one."""
    usable = np.where(is_unit(frames.rotations)[..., np.newaxis], frames.rotations, 0.0)
    length = np.linalg.norm(usable, axis=-1, keepdims=True)
    scaled: Rotations = np.rint(usable / np.maximum(length, 1.0) * ROTATION_SCALE).astype(np.int16)
    return scaled


def encode(movement: Movement) -> bytes:
    """Return the movement as bytes, the participant first."""
    bodies = sorted(movement.positions_m, reverse=True)
    errors = np.ascontiguousarray(movement.errors_rad, dtype="<f4")
    header = json.dumps(
        {
            "names": JOINT_NAMES,
            "parents": PARENTS,
            "bodies": [str(body) for body in bodies],
            "frames": movement.grid.count,
            "rate_hz": movement.grid.rate_hz,
            "error_joints": ERROR_JOINTS,
            "error_frames": errors.shape[0],
            "error_rate_hz": movement.error_grid.rate_hz,
            "gaps": [[round(a, 4), round(b, 4)] for a, b in movement.gaps],
            **({"rotations": True} if movement.rotations else {}),
            **({"finger_parts": FINGER_PARTS} if movement.fingers else {}),
        }
    ).encode()
    header += b" " * (-len(header) % 4)
    places = [np.ascontiguousarray(movement.positions_m[body], dtype="<f4") for body in bodies]
    parts = (place.tobytes() for place in places)
    turns = (
        of_parts[body].astype("<i2").tobytes()
        for of_parts in (movement.rotations, movement.fingers)
        for body in bodies[: len(of_parts)]
    )
    return b"".join((struct.pack("<I", len(header)), header, *parts, errors.tobytes(), *turns))


def _rate_hz(recording: Recording, bodies: int, finger_parts: int) -> float:
    # Four components of 16 bits take as much as two numbers.
    numbers_a_frame = (5 if recording.rotations else 3) * JOINT_COUNT + 2 * finger_parts
    numbers_a_second = numbers_a_frame * bodies * max(recording.duration_s, 1e-3)
    return min(MAX_HZ, MAX_NUMBERS / numbers_a_second)


def placed_movement(
    database: Database, session_id: str, phase_id: int, *, full: bool, rotations: bool = False
) -> bytes:
    """Read and encode the movement of a phase (see `encode`); `full`: with the avatar."""
    with database.reading() as db:
        session = session_by_id(db, session_id)
        phase = db.get_one(Phase, (session_id, phase_id))
        clock = phase_clock(db, session, phase)
        recording = Recording(
            session_id,
            phase_id,
            clock.offsets_s,
            clock.duration_s,
            body_of(db, session, phase, full=full).skeleton(),
            full=full,
            hinges=hinges_of(db, session_id, phase_id) if full else None,
            rotations=rotations,
        )
        return encode(movement_of(db, recording))
