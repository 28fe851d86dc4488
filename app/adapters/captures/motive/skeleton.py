"""Convert a Motive skeleton's bones to a rig, with offsets computed from their movement.

In Motive's T-pose the axes of every bone are the world's, so the rest rotations are identities and
the offset of a bone, in its parent's frame, is its offset in the T-pose. The solver lets bones
stretch a little; the median over the take is used as the offset. While a skeleton was not visible,
its movement is interpolated between the frames around the gap.
"""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from app.adapters.captures.capture import CaptureError
from app.adapters.captures.tables import unseen
from app.science.rig import BoolArray, Rig, RigMotion, to_local, to_world
from app.science.rotations import FloatArray, conjugate, identity, rotate, slerp

_NOTICEABLE_M = 1e-3


def skeleton_motion(
    names: Sequence[str],
    parents: Sequence[int],
    places_m: FloatArray,
    rotations: FloatArray,
    rate_hz: float,
    *,
    local: bool,
) -> tuple[RigMotion, list[str]]:
    """Make a rig of bones (N, J), parents first, given in the world or relative to their parents.

    Returns:
        The movement, and notes on gaps and on bones that stretch.

    Raises:
        CaptureError: a bone is never visible.
    """
    seen = ~unseen(places_m, rotations)
    _check_seen(names, seen)
    filled_places, filled_turns = np.empty_like(places_m), np.empty_like(rotations)
    for joint in range(len(names)):
        filled_places[:, joint] = _fill_places(places_m[:, joint], seen[:, joint])
        filled_turns[:, joint] = _fill_rotations(rotations[:, joint], seen[:, joint])
    relative = filled_places if local else _relative(parents, filled_places, filled_turns)
    offsets = np.zeros((len(names), 3))
    for joint in range(1, len(names)):
        offsets[joint] = np.median(relative[seen[:, joint], joint], axis=0)
    rig = Rig(tuple(names), tuple(parents), offsets, identity(len(names)))
    motion = RigMotion(
        rig=rig,
        rate_hz=rate_hz,
        root_positions_m=filled_places[:, 0],
        rotations=filled_turns if local else to_local(rig, filled_turns),
        observed=seen,
    )
    return motion, [*_gap_notes(seen), *_stretch_notes(motion, places_m, seen, local=local)]


def _check_seen(names: Sequence[str], seen: npt.NDArray[np.bool_]) -> None:
    never = np.flatnonzero(np.logical_not(seen.sum(axis=0)))
    if never.size:
        raise CaptureError(f"bone {names[never[0]]} has no place and rotation in any frame.")


def _relative(parents: Sequence[int], places: FloatArray, world: FloatArray) -> FloatArray:
    relative = places.copy()
    above = list(parents[1:])
    relative[:, 1:] = rotate(conjugate(world[:, above]), places[:, 1:] - places[:, above])
    return relative


def _gap_notes(seen: npt.NDArray[np.bool_]) -> list[str]:
    broken = int((~seen).any(axis=1).sum())
    if not broken:
        return []
    return [f"{broken} of {len(seen)} frames lack bones; these were carried over the gap."]


def _stretch_notes(
    motion: RigMotion, places_m: FloatArray, seen: npt.NDArray[np.bool_], *, local: bool
) -> list[str]:
    if local:
        apart = np.linalg.norm(places_m - motion.rig.offsets_m, axis=-1)
        apart[:, 0] = 0.0
    else:
        modelled, _ = to_world(motion.rig, motion.root_positions_m, motion.rotations)
        apart = np.linalg.norm(places_m - modelled, axis=-1)
    apart = np.where(seen, apart, 0.0)
    worst = float(apart.max())
    if worst < _NOTICEABLE_M:
        return []
    name = motion.rig.names[int(np.unravel_index(np.argmax(apart), apart.shape)[1])]
    return [
        f"Bones stretch in the file: with bones of one length {name} is off by up to {worst:.3f} m."
    ]


def _fill_places(places: FloatArray, seen: BoolArray) -> FloatArray:
    """Interpolate positions (N, 3) linearly over gaps.

    At both ends the nearest position is used.
    """
    if seen.all():
        return places
    visible, frames = np.flatnonzero(seen), np.arange(len(seen))
    return np.stack(
        [np.interp(frames, visible, places[visible, axis]) for axis in range(places.shape[1])],
        axis=-1,
    )


def _fill_rotations(rotations: FloatArray, seen: BoolArray) -> FloatArray:
    """Interpolate rotations (N, 4) over gaps by the shorter rotation at constant speed."""
    if seen.all():
        return rotations
    visible, missing = np.flatnonzero(seen), np.flatnonzero(~seen)
    index = np.searchsorted(visible, missing)
    before = visible[np.clip(index - 1, 0, len(visible) - 1)]
    after = visible[np.clip(index, 0, len(visible) - 1)]
    span = np.maximum(after - before, 1)
    fraction = np.clip((missing - before) / span, 0.0, 1.0)
    filled = rotations.copy()
    filled[missing] = slerp(rotations[before], rotations[after], fraction)
    return filled
