"""Read the movement of a session that the product itself exported: a file of its `samples`.

A file has one row per frame, with the hips and the local rotations of all joints of the target,
which is what the tracking says, and of the body that the participant saw. Places of hands are not
in it: they follow from the rotations on a body of the participant's stature.
"""

from dataclasses import dataclass
from pathlib import Path
from typing import Final

import numpy as np

from app.science.rotations import FloatArray, rotate
from app.science.skeleton import JOINT_INDEX, JOINT_NAMES, build_skeleton, forward_kinematics

_ROOT: Final = tuple(f"target_root_{axis}_m" for axis in "xyz")
_TURNS: Final = tuple(f"target_{joint}_q{part}" for joint in JOINT_NAMES for part in "wxyz")
_STATE: Final = ("simulated", "epoch", "phase_id", "t_s", "flagged")
MOST_BYTES: Final = 4_000_000_000
HANDS: Final = ("LeftHand", "RightHand")


class SamplesError(ValueError):
    """A file of samples cannot be read; the message says what is missing."""


@dataclass(frozen=True, eq=False)
class PhaseOfHands:
    """The hands of one run of frames in a phase.

    Attributes:
        phase_id: the phase.
        times_s: (N,) increasing times.
        tips_m: (N, 2, 3) tips of the left and the right hand, NaN in frames that were flagged.
        hips_m: (N, 3) the hips, NaN there, too.
    """

    phase_id: int
    times_s: FloatArray
    tips_m: FloatArray
    hips_m: FloatArray


@dataclass(frozen=True, eq=False)
class SessionSamples:
    """The hands of a session, and whether a simulation made it."""

    simulated: bool
    phases: tuple[PhaseOfHands, ...]


def is_session_samples(path: Path) -> bool:
    """Return whether a file is an export of samples, by its first line; raise OSError."""
    with path.open("rb") as file:
        titles = file.readline(100_000).decode("utf-8-sig", errors="replace").strip().split(",")
    return {*_ROOT, "phase_id"} <= set(titles)


def read_session_samples(path: Path, stature_m: float) -> SessionSamples:
    """Read the hands of a session, on a body of a stature, in all frames within phases.

    Raises:
        SamplesError: a column is missing, a cell is not a number, or no frame is in a phase.
        OSError: the file cannot be opened.
    """
    import pandas as pd

    if path.stat().st_size > MOST_BYTES:
        raise SamplesError(f"{path}: larger than {MOST_BYTES} bytes, which is the limit.")
    wanted = [*_STATE, *_ROOT, *_TURNS]
    try:
        table = pd.read_csv(path, usecols=wanted)
        numbers = table[["epoch", "phase_id", "t_s", *_ROOT, *_TURNS]].to_numpy(dtype=np.float64)
    except ValueError as error:
        raise SamplesError(f"{path}: not samples as an export has them ({error}).") from error
    truths = (
        table[["simulated", "flagged"]].astype(str).apply(lambda one: one.str.lower() == "true")
    )
    simulated, flagged = (truths[name].to_numpy() for name in ("simulated", "flagged"))
    inside = numbers[:, 1] > 0.0
    if not inside.any():
        raise SamplesError(f"{path}: no frame is in a phase; give the file of a whole session.")
    skeleton = build_skeleton(stature_m)
    root_m = numbers[:, 3:6]
    turns = np.where(flagged[:, None, None], np.nan, numbers[:, 6:].reshape(len(numbers), -1, 4))
    world = forward_kinematics(skeleton, root_m, turns)
    hands = [JOINT_INDEX[name] for name in HANDS]
    tips_m = world.positions_m[:, hands] + rotate(world.rotations[:, hands], skeleton.ends_m[hands])
    hips_m = np.where(flagged[:, None], np.nan, root_m)
    # A new run begins with another epoch or phase, and where the clock starts again.
    keys = numbers[:, :2]
    begins = (np.diff(keys, axis=0) != 0.0).any(axis=1) | (np.diff(numbers[:, 2]) <= 0.0)
    runs = np.split(np.arange(len(numbers)), np.flatnonzero(begins) + 1)
    phases = tuple(
        PhaseOfHands(int(numbers[run[0], 1]), numbers[run, 2], tips_m[run], hips_m[run])
        for run in runs
        if inside[run[0]] and len(run) > 1
    )
    return SessionSamples(bool(simulated.any()), phases)
