"""Retarget a movement to an avatar and measure both walks.

This is what a command, a server and a rehearsal all do with a capture once it is read: transfer it
(`transfer`), lock the feet if requested (`foot_locking`), else raise the body where its feet would
be under flat ground (`skeleton.clearance`), and measure the walk (`gait`). Both walks
are measured over the source's contacts, so step number i is the same step in both, and under
uniform scaling the ratio of their lengths is that of the legs.
"""

from dataclasses import dataclass, replace

import numpy as np

from app.science.anatomy import Notice
from app.science.retargeting.anatomy_checks import (
    foot_notice,
    knee_notice,
    one_sided_notice,
    sides_notice,
    stature_notice,
    step_height_notice,
    toes_notice,
    uneven_steps_notice,
)
from app.science.retargeting.contacts import find_contacts
from app.science.retargeting.foot_locking import LockedFeet, lock_feet
from app.science.retargeting.foot_points import FootPoints
from app.science.retargeting.gait import Walk, walk_figures
from app.science.retargeting.ground import Flat, Ground
from app.science.retargeting.joint_map import JointMap
from app.science.retargeting.legs import has_legs, legs_of
from app.science.retargeting.proportions import ScaledBy
from app.science.retargeting.transfer import Retargeter
from app.science.rig import Rig, RigError, RigMotion
from app.science.rotations import FloatArray
from app.science.skeleton import clearance_m

_FLAT = Flat()
# About half a step: the time in which a body goes up or down an edge.
_EASING_S = 0.3
# In heights of the avatar's T-pose, so that bodies of all sizes sink alike: 4 mm for 165 cm.
_ALLOWED_DEPTH = 0.003


@dataclass(frozen=True, eq=False)
class Walks:
    """Measures of the same walk by the source and by the avatar, and the result of foot locking.

    Attributes:
        source, avatar: measured over the source's contacts; the avatar's after foot locking.
        slide_before_m_s: the avatar's mean foot slide before foot locking; None without contact.
        locked: result of foot locking; None where it was not requested.
    """

    source: Walk
    avatar: Walk
    slide_before_m_s: float | None
    locked: LockedFeet | None

    @property
    def slide_m_s(self) -> float | None:
        """The avatar's mean foot slide after any foot locking; None without contact."""
        return self.avatar.slide_m_s


@dataclass(frozen=True)
class FloorClearance:
    """How deep an avatar's feet are under the ground, and what keeping them above it costs.

    Attributes:
        sunk_m: greatest depth of a joint or end of the feet without any correction, at least 0.
        left_m: the same in the result.
        raised_m, mean_raised_m: by how much the body is raised at most, and on average over all
            frames; feet float by as much. Zero with locked feet and on uneven ground.
        lifted_m: with locked feet on flat ground, by how much a single foot is lifted at most.
    """

    sunk_m: float
    left_m: float
    raised_m: float
    mean_raised_m: float
    lifted_m: float = 0.0


@dataclass(frozen=True, eq=False)
class Retargeted:
    """A movement retargeted to an avatar.

    Attributes:
        motion: the avatar's movement.
        scale: factor on the hips' travel.
        scaled_by: "legs", or what determined the scale where one of the bodies has no legs.
        carried: body joints that move the avatar.
        unmapped_avatar_joints: joints that keep their T-pose.
        unmapped_source_joints: joints that move no joint of the avatar themselves.
        walks: measures of both walks; None where one of the bodies has no legs.
        floor: how deep the feet are, and by how much the body was raised.
        notices: what the walk shows to be wrong with the capture or its map (`anatomy_checks`).
    """

    motion: RigMotion
    scale: float
    scaled_by: ScaledBy
    carried: tuple[str, ...]
    unmapped_avatar_joints: tuple[str, ...]
    unmapped_source_joints: tuple[str, ...]
    walks: Walks | None
    floor: FloorClearance
    notices: tuple[Notice, ...] = ()

    @property
    def leg_ratio(self) -> float | None:
        """Leg length of the avatar over the source's; None if one of them has no legs."""
        return self.scale if self.scaled_by == "legs" else None


def retarget_motion(
    source: RigMotion,
    source_map: JointMap,
    avatar: Rig,
    avatar_map: JointMap,
    *,
    ground: Ground = _FLAT,
    lock: bool = False,
    standing_frame: int = 0,
) -> Retargeted:
    """Retarget a movement to an avatar and measure it.

    Args:
        source: the capture's movement.
        source_map: body joint -> joint of its rig.
        avatar: any rig; its rest pose is aligned to the T-pose automatically.
        avatar_map: body joint -> joint of the avatar.
        ground: the ground under the avatar.
        lock: whether to hold the avatar's feet while the source's are down.
        standing_frame: a frame in which the source stands on the ground.

    Raises:
        RigError: a map does not match its rig, or feet are to be locked and one body has no legs.
    """
    legged = has_legs(source_map) and has_legs(avatar_map)
    if lock and not legged:
        raise RigError(
            "Feet can be locked only if both bodies have legs: turn foot locking off, or map"
            " both legs from the hips to the feet."
        )
    retargeter = Retargeter(source.rig, source_map, avatar, avatar_map)
    # Locked feet raise the body with the ground; without locking the ground below the hips does.
    moved = retargeter.batch(source, _FLAT if lock else ground, standing_frame=standing_frame)
    if not lock:
        moved = _smooth_edges(retargeter, moved, ground)
    sunk_m = _depth_m(retargeter.foot_points, moved, ground)
    raise_m = np.zeros(moved.frame_count)
    if not lock and isinstance(ground, Flat):
        raise_m = _clearance_m(retargeter, moved, ground)
        moved = _raised(moved, raise_m)
    walks = _walks(source, source_map, moved, avatar_map, ground, lock=lock) if legged else None
    locked = None if walks is None else walks.locked
    motion = moved if locked is None else locked.motion
    left_m = _depth_m(retargeter.foot_points, motion, ground)
    floor = FloorClearance(
        sunk_m,
        left_m,
        float(raise_m.max()),
        float(raise_m.mean()),
        0.0 if locked is None else locked.lifted_m,
    )
    notices = (
        sides_notice(source, source_map),
        foot_notice(source, source_map),
        knee_notice(source, source_map),
        toes_notice(source, source_map),
        stature_notice(None if walks is None else walks.source.leg_length_m),
        _step_notice(walks, retargeter.scale),
        _uneven_notice(walks),
        _one_sided_notice(walks),
    )
    found = tuple(notice for notice in notices if notice is not None)
    return replace(_result(retargeter, motion, walks, floor), notices=found)


def _uneven_notice(walks: Walks | None) -> Notice | None:
    if walks is None:
        return None
    height_m = walks.source.mean_step_height_of_m
    return uneven_steps_notice(height_m("left"), height_m("right"))


def _one_sided_notice(walks: Walks | None) -> Notice | None:
    if walks is None:
        return None
    sides = [stride.side for stride in walks.source.strides]
    return one_sided_notice(sides.count("left"), sides.count("right"))


def _step_notice(walks: Walks | None, leg_ratio: float) -> Notice | None:
    if walks is None:
        return None
    heights = (walks.source.mean_step_height_m, walks.avatar.mean_step_height_m)
    return step_height_notice(*heights, leg_ratio)


def _clearance_m(retargeter: Retargeter, moved: RigMotion, ground: Ground) -> FloatArray:
    """Return by how much the body is raised, (N,), so that its feet stay above flat ground."""
    height = _foot_height_m(retargeter.foot_points, moved, ground)
    heights = retargeter.avatar_t_pose.positions_m[:, 1]
    allowed_m = _ALLOWED_DEPTH * float(np.ptp(heights))
    return clearance_m(height, moved.rate_hz, allowed_m=allowed_m)


def _result(
    retargeter: Retargeter, motion: RigMotion, walks: Walks | None, floor: FloorClearance
) -> Retargeted:
    return Retargeted(
        motion=motion,
        scale=retargeter.scale,
        scaled_by=retargeter.scaled_by,
        carried=retargeter.carried,
        unmapped_avatar_joints=retargeter.unmapped_avatar_joints,
        unmapped_source_joints=retargeter.unmapped_source_joints,
        walks=walks,
        floor=floor,
    )


def _depth_m(points: FootPoints, motion: RigMotion, ground: Ground) -> float:
    return max(0.0, -float(_foot_height_m(points, motion, ground).min()))


def _foot_height_m(points: FootPoints, motion: RigMotion, ground: Ground) -> FloatArray:
    """Return the height of the lowest joint or end of the feet above the ground, (N,)."""
    places = points.all_places_m(motion)
    heights = places[..., 1] - ground.height_m(places[..., 0], places[..., 2])
    return np.asarray(heights.min(axis=1))


def _raised(motion: RigMotion, raise_m: FloatArray) -> RigMotion:
    if not raise_m.any():
        return motion
    root = motion.root_positions_m.copy()
    root[:, 1] += raise_m
    return replace(motion, root_positions_m=root)


def _smooth_edges(retargeter: Retargeter, moved: RigMotion, ground: Ground) -> RigMotion:
    """Smooth the edges of the ground, so that the body does not jump up or down at a kerb.

    The height below the hips is replaced by its mean over nearby frames. The ends are continued by
    their mirror image through the last point, so that the first frame is unchanged, as are all
    frames on level ground and constant slopes.
    """
    hips = retargeter.hips_m(moved.root_positions_m, moved.rotations)
    height = ground.height_m(hips[:, 0], hips[:, 2])
    reach = min(round(_EASING_S * moved.rate_hz), moved.frame_count - 1)
    if reach < 1 or not float(np.ptp(height)) > 0.0:
        return moved
    longer = np.pad(height, reach, mode="reflect", reflect_type="odd")
    window = np.hanning(2 * reach + 3)[1:-1]
    root = moved.root_positions_m.copy()
    root[:, 1] += np.convolve(longer, window / window.sum(), mode="valid") - height
    return replace(moved, root_positions_m=root)


def _walks(
    source: RigMotion,
    source_map: JointMap,
    moved: RigMotion,
    avatar_map: JointMap,
    ground: Ground,
    *,
    lock: bool,
) -> Walks:
    source_legs, legs = legs_of(source.rig, source_map), legs_of(moved.rig, avatar_map)
    contacts = find_contacts(source, source_legs)
    before = walk_figures(moved, legs, ground, contacts)
    locked = lock_feet(moved, avatar_map, contacts, ground) if lock else None
    return Walks(
        source=walk_figures(source, source_legs, contacts=contacts),
        avatar=before if locked is None else walk_figures(locked.motion, legs, ground, contacts),
        slide_before_m_s=before.slide_m_s,
        locked=locked,
    )
