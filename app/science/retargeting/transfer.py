"""Transfer any body's movement to any avatar, live or from a file.

Every joint of the avatar that the source also has turns in the world as the source's does, relative
to the pose that both share, the T-pose (`t_pose`), with both bodies brought to face the same way:

    D_j = world_from_source_j(t) world_from_source_j(T-pose)^-1,
    world_from_avatar_j(t) = D_j world_from_avatar_j(T-pose).

For a source whose T-pose rotations are the identity (OptiTrack Motive) this is the paper's Q_avatar
= Q_capture Q_T. Other avatar joints keep their T-pose local rotation. Only the hips are translated:

    p_hips(t) = scale p_source_hips(t) + (0, offset, 0),   scale = leg length avatar / source,

so that the bones keep their lengths; the offset puts the feet on the ground. If the bodies are
scaled copies of each other, steps are scaled exactly and no foot slides; with other proportions
feet slide as far as the shapes of the legs differ.

Source: Degen et al. (2022), "Methodical approach to integrate human movement diversity ...", J.
Transportation Technologies 12:296-309, sections 2.3 and 3.
"""

from collections.abc import Mapping
from types import MappingProxyType

import numpy as np

from app.science.retargeting.bones import joints_of
from app.science.retargeting.foot_points import FootPoints
from app.science.retargeting.ground import Flat, Ground
from app.science.retargeting.joint_map import JointMap
from app.science.retargeting.plan import body_of, constant_factors, plan_of
from app.science.retargeting.proportions import ScaledBy, scale_between
from app.science.retargeting.t_pose import t_pose
from app.science.rig import Rig, RigError, RigMotion, to_world
from app.science.rotations import FloatArray, Vector

_FLAT = Flat()
_FLOAT64 = np.dtype(np.float64)


class Retargeter:
    """Transfers movement from one rig to one avatar.

    It owns scratch memory, so that a frame allocates only its result; it must not be used by
    several threads simultaneously.

    Attributes:
        source, avatar: the rigs.
        source_t_pose, avatar_t_pose: the pose that they share.
        carried: body joints that both maps contain, which move the avatar.
        scale: factor on the hips' travel.
        scaled_by: the body part that determined the scale; `legs` unless a body has no legs.
        moved_by: (A,) the source joint that moves each of the avatar's, -1 for none.
        foot_points: the points of the avatar that stand on the ground.
        factors: (A, 4) right factors on the source joints' world rotations; for a joint that none
            moves, the T-pose's local rotation.
    """

    def __init__(
        self,
        source: Rig,
        source_map: JointMap,
        avatar: Rig,
        avatar_map: JointMap,
        *,
        source_local_axes: Mapping[str, Vector] = MappingProxyType({}),
        avatar_local_axes: Mapping[str, Vector] = MappingProxyType({}),
    ) -> None:
        """Align both bodies and prepare the transfer.

        Args:
            source, avatar: any two skeletons, y up.
            source_map, avatar_map: body joint -> joint of that rig; both need the hips.
            source_local_axes, avatar_local_axes: the `local_axes` of each rig; see `t_pose`.

        Raises:
            JointMapError: a map does not match its rig, or leaves the hips out.
        """
        self.source, self.avatar = source, avatar
        self.source_t_pose = t_pose(source, source_map, local_axes=source_local_axes)
        self.avatar_t_pose = t_pose(avatar, avatar_map, local_axes=avatar_local_axes)
        source_joints, avatar_joints = joints_of(source, source_map), joints_of(avatar, avatar_map)
        self.carried = tuple(name for name in avatar_joints if name in source_joints)
        scale = scale_between(self.source_t_pose, source_map, self.avatar_t_pose, avatar_map)
        self.scale: float = scale.factor
        self.scaled_by: ScaledBy = scale.scaled_by
        self.moved_by = np.full(avatar.joint_count, -1, dtype=np.int64)
        for name in self.carried:
            self.moved_by[avatar_joints[name]] = source_joints[name]
        self.factors = constant_factors(self.source_t_pose, self.avatar_t_pose, self.moved_by)
        self.foot_points = FootPoints(avatar, avatar_map)
        self._prepare(source_joints["Hips"], avatar_joints["Hips"])

    def _prepare(self, source_hips: int, avatar_hips: int) -> None:
        from app.science.retargeting import kernels  # loads the compiler, which takes half a second

        moving = [joint for joint in self.moved_by.tolist() if joint >= 0]
        source = body_of(self.source, moving, source_hips)
        avatar = body_of(self.avatar, range(self.avatar.joint_count), avatar_hips)
        self._plan = plan_of(source, avatar, self.moved_by, self.factors, self.scale)
        self._scratch = np.zeros((2, self._plan.joints.shape[1], 4, kernels.BLOCK))
        self._transfer, self._transfer_frame = kernels.transfer, kernels.transfer_frame
        self._avatar_hips = avatar_hips

    @property
    def leg_ratio(self) -> float | None:
        """Leg length of the avatar over the source's; None if one of them has no legs."""
        return self.scale if self.scaled_by == "legs" else None

    @property
    def unmapped_avatar_joints(self) -> tuple[str, ...]:
        """Joints of the avatar that keep their T-pose local rotation."""
        pairs = zip(self.avatar.names, self.moved_by, strict=True)
        return tuple(name for name, mover in pairs if mover < 0)

    @property
    def unmapped_source_joints(self) -> tuple[str, ...]:
        """Joints of the source that move no joint of the avatar themselves."""
        moving = set(self.moved_by.tolist())
        return tuple(n for joint, n in enumerate(self.source.names) if joint not in moving)

    def frame(
        self, root_position_m: FloatArray, rotations: FloatArray, hips_offset_m: float = 0.0
    ) -> tuple[FloatArray, FloatArray]:
        """Transfer one frame.

        Args:
            root_position_m, rotations: (3,) and (S, 4) of the source, as in `RigMotion`.
            hips_offset_m: added to the hips' height; see `hips_offset_m`.

        Returns:
            Root position (3,) and local rotations (A, 4) of the avatar.

        Raises:
            RigError: the arrays do not have the shapes of a frame of the source.
        """
        if root_position_m.shape != (3,) or rotations.shape != (self.source.joint_count, 4):
            raise RigError(
                f"Root {root_position_m.shape} and rotations {rotations.shape} are not a frame of"
                f" this source: give (3,) and ({self.source.joint_count}, 4)."
            )
        root, local = np.empty(3), np.empty((self.avatar.joint_count, 4))
        self._transfer_frame(
            _plain(root_position_m),
            _plain(rotations),
            self._plan.joints,
            self._plan.numbers,
            self._scratch,
            float(hips_offset_m),
            root,
            local,
        )
        return root, local

    def batch(
        self, motion: RigMotion, ground: Ground | None = None, *, standing_frame: int = 0
    ) -> RigMotion:
        """Transfer a movement, standing on the ground and following its height.

        In the standing frame the lowest point of the feet is on the ground. Relative to that frame,
        the hips rise and fall with the ground below them.

        Args:
            motion: the movement of the source.
            ground: flat at height zero by default.
            standing_frame: a frame in which the source stands; negative counts from the end.

        Returns:
            The avatar's movement. A joint counts as observed where its source joint was; joints
            that keep their T-pose always do.

        Raises:
            RigError: the movement has a different rig, or no such frame.
        """
        self._check(motion, standing_frame)
        ground = _FLAT if ground is None else ground
        roots = np.empty((motion.frame_count, 3))
        local = np.empty((motion.frame_count, self.avatar.joint_count, 4))
        self._transfer(
            _plain(motion.root_positions_m),
            _plain(motion.rotations),
            self._plan.joints,
            self._plan.numbers,
            self._scratch,
            0.0,
            roots,
            local,
        )
        offset = self._standing(roots[standing_frame], local[standing_frame], ground)
        hips = self.hips_m(roots, local)
        height = ground.height_m(hips[:, 0], hips[:, 2])
        roots[:, 1] += offset + (height - height[standing_frame])
        observed = np.where(self.moved_by >= 0, motion.observed[:, self.moved_by], True)
        return RigMotion(self.avatar, motion.rate_hz, roots, local, observed)

    def hips_offset_m(
        self, root_position_m: FloatArray, rotations: FloatArray, ground: Ground | None = None
    ) -> float:
        """Return the offset that puts the avatar's lower foot on the ground in this frame.

        The arguments are a frame of the source, (3,) and (S, 4). While the avatar moves on uneven
        ground, add the difference of the ground's height below the hips to it, as `batch` does.
        """
        root, local = self.frame(root_position_m, rotations)
        return self._standing(root, local, _FLAT if ground is None else ground)

    def hips_m(self, roots: FloatArray, local: FloatArray) -> FloatArray:
        """Return the avatar's hip positions, (..., 3), for frames (..., 3) and (..., A, 4)."""
        if self._avatar_hips == 0:
            return roots
        return to_world(self.avatar, roots, local)[0][..., self._avatar_hips, :]

    def _standing(self, root: FloatArray, local: FloatArray, ground: Ground) -> float:
        points = self.foot_points.places_m(root, local)
        return -float(np.min(points[:, 1] - ground.height_m(points[:, 0], points[:, 2])))

    def _check(self, motion: RigMotion, standing_frame: int) -> None:
        if motion.rig.fingerprint != self.source.fingerprint:
            raise RigError(
                "The movement has a different skeleton from the retargeter's source: make a"
                " retargeter for its rig."
            )
        if not -motion.frame_count <= standing_frame < motion.frame_count:
            raise RigError(
                f"There is no standing frame {standing_frame}: the movement has frames 0 to"
                f" {motion.frame_count - 1}."
            )


def _plain(array: FloatArray) -> FloatArray:
    """Return the array in the layout the kernel was compiled for; others trigger a compilation."""
    if array.flags.carray and array.dtype is _FLOAT64:
        return array
    return np.array(array, dtype=np.float64, order="C")
