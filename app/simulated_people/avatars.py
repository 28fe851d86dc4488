"""The remote avatar of a simulated person: a delayed copy, or a body that follows by forces."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol, cast

import mujoco
import numpy as np
from numpy.typing import NDArray

from app.science.avatar.configuration import (
    Configuration,
    RunningSettings,
    as_configured,
    world_limbs,
)
from app.science.avatar.mjcf import SimulationError
from app.science.avatar.simulation import Follower, PhysicsAvatar, SurfaceTouches
from app.science.avatar.targets import TargetAngles
from app.science.delay import DelayBuffer
from app.science.rotations import Vector, rotate
from app.science.simulation import FingerCapsules
from app.science.skeleton import (
    FINGER_PARTS,
    JOINT_COUNT,
    JOINT_INDEX,
    JOINT_NAMES,
    Pose,
    Skeleton,
    WorldPose,
    body_part_segments,
    forward_kinematics,
)
from app.science.tasks import SurfaceArrays, TaskLayout, touching_and_near
from app.wire import AvatarOrder

FloatArray = NDArray[np.float64]
Bools = NDArray[np.bool_]
RELEASE_MARGIN_M = 0.005
"""How far a part may move away from a surface before its touch ends."""


class CannotChange(ValueError):
    """An avatar cannot be changed while it runs; the message says why."""


class RemoteAvatar(Protocol):
    """The body that the participant sees as their own.

    It has fingers of its own once it is given those of the participant. `fingers` are then the
    local rotations (30, 4) of the last frame, and their touches are reported finger by finger.
    """

    fingers: FloatArray | None

    @property
    def parts(self) -> tuple[str, ...]:
        """Return the P parts whose touches are reported."""

    def set_latency(self, latency_s: float) -> None:
        """Set the latency with which the avatar follows from now on."""

    def show_boxes(self, layout: TaskLayout | None) -> None:
        """Place the boxes of a task in the room, or remove all."""

    def change(self, order: AvatarOrder) -> dict[str, float]:
        """Bring the avatar to the changes of an order; return the angle of each held axis.

        Raises CannotChange if the avatar cannot be changed.
        """

    def frame(self, t_s: float, pose: Pose, fingers: FloatArray | None = None) -> Pose:
        """Return the avatar's pose for the participant's pose; called for every frame.

        `fingers`: the participant's finger parts (30, 4), given with every frame or with none.
        """

    def place_of(self, effector: str) -> Vector:
        """Return where a limb is seen at the last frame: a finger tip of a hand, or an ankle.

        `effector`: a hand or a foot, as a goal names it.
        """

    def touches(self) -> tuple[Bools, Bools]:
        """Return the avatar's touches at the last frame, and what is near enough to keep one.

        Two bool arrays (S, P), surfaces of the task by parts; (0, P) without boxes.
        """


class DelayedCopy:
    """A copy of the participant's own movement, with every joint except the hips delayed."""

    def __init__(self, skeleton: Skeleton, *, with_fingers: bool = False) -> None:
        self._skeleton, self._delay = skeleton, DelayBuffer(0.0)
        self._surfaces: SurfaceArrays | None = None
        self._pose: Pose | None = None
        self._posed: WorldPose | None = None
        self.fingers: FloatArray | None = None
        self._hands = FingerCapsules(skeleton) if with_fingers else None

    @property
    def parts(self) -> tuple[str, ...]:
        """Return the joints of the skeleton and, if it has any, the parts of its fingers."""
        return JOINT_NAMES if self._hands is None else (*JOINT_NAMES, *FINGER_PARTS)

    def set_latency(self, latency_s: float) -> None:
        """Set the delay of the joints from now on."""
        self._delay.set_delay(latency_s)

    def show_boxes(self, layout: TaskLayout | None) -> None:
        """Set the surfaces whose touches are detected; a copy passes through everything."""
        self._surfaces = None if layout is None else SurfaceArrays.of(layout)

    def change(self, order: AvatarOrder) -> dict[str, float]:
        """Refuse: a copy has no motors and no colliders."""
        raise CannotChange(f"a delayed copy cannot be changed (revision {order.revision})")

    def frame(self, t_s: float, pose: Pose, fingers: FloatArray | None = None) -> Pose:
        """Return the current position of the hips with the delayed rotations of the joints."""
        whole = pose.rotations if fingers is None else np.concatenate((pose.rotations, fingers))
        delayed = self._delay.push(t_s, whole)
        self._pose, self._posed = Pose(pose.root_position_m, delayed[:JOINT_COUNT]), None
        self.fingers = None if fingers is None else delayed[JOINT_COUNT:]
        return self._pose

    def place_of(self, effector: str) -> Vector:
        """Return where the delayed limb is at the last frame."""
        world, at = self._world(), JOINT_INDEX[effector]
        place = world.positions_m[at]
        if effector.endswith("Hand"):
            place = place + rotate(world.rotations[at], self._skeleton.ends_m[at])
        return cast("Vector", tuple(place.tolist()))

    def _world(self) -> WorldPose:
        """Return the joints of the last frame in the world, computed once per frame."""
        if self._posed is None:
            if self._pose is None:
                raise RuntimeError("there is no frame yet")
            self._posed = forward_kinematics(
                self._skeleton, self._pose.root_position_m, self._pose.rotations
            )
        return self._posed

    def touches(self) -> tuple[Bools, Bools]:
        """Return touches, determined by the distances between the body's capsules and the boxes."""
        if self._surfaces is None or self._pose is None:
            return no_touches(self.parts)
        world = self._world()
        body = body_part_segments(self._skeleton, world)
        axes_m, radii_m = body.axes_m, body.radii_m
        if self._hands is not None and self.fingers is not None:
            axes_m, radii_m = self._hands.added_to(body, world, self.fingers)
        return touching_and_near(self._surfaces, axes_m, radii_m, RELEASE_MARGIN_M)


def no_touches(parts: Sequence[str]) -> tuple[Bools, Bools]:
    """Return empty touches of these parts, as when there are no boxes."""
    nothing = np.zeros((0, len(parts)), dtype=np.bool_)
    return nothing, nothing


class PhysicsBody:
    """A simulated body that starts in the participant's first pose, without boxes.

    Args:
        mjcf: the model, with the boxes of all tasks.
        configuration: the one that the model was built from.
        hips_scale: the height of its hips when standing, as a share of the participant's.
        with_fingers: whether it is given the participant's fingers with every frame.
    """

    def __init__(
        self,
        mjcf: str,
        configuration: Configuration,
        hips_scale: float = 1.0,
        *,
        with_fingers: bool = False,
    ) -> None:
        self._hips_scale = np.array([1.0, hips_scale, 1.0])
        self.avatar = PhysicsAvatar(mjcf)
        self.avatar.boxes.show(())
        angles = TargetAngles(configuration.in_force, self.avatar.parts)
        self._follower = Follower(
            self.avatar,
            angles,
            target_space=configuration.target_space,
            world_limbs=world_limbs(configuration.compliance),
        )
        self._touches: SurfaceTouches | None = None
        self._configured = as_configured(configuration)
        self._began_s: float | None = None
        self.fingers: FloatArray | None = None
        self._with_fingers = with_fingers
        self._limbs = _limbs_of(self.avatar.model)

    @property
    def parts(self) -> tuple[str, ...]:
        """Return the joints of the skeleton and, if it has any, the parts of its fingers."""
        return (*JOINT_NAMES, *FINGER_PARTS) if self._with_fingers else JOINT_NAMES

    def put_on(self) -> None:
        """Begin anew with the next frame, at rest in the participant's pose."""
        if self._began_s is not None:
            self.avatar.rewind()
            self._began_s = None

    def set_latency(self, latency_s: float) -> None:
        """Set the delay of the motors' targets from now on."""
        self._follower.set_delay(latency_s)

    def show_boxes(self, layout: TaskLayout | None) -> None:
        """Place the boxes of a task in the room, or remove all."""
        names = () if layout is None else tuple(surface.key for surface in layout.surfaces)
        self.avatar.boxes.show(names)
        self._touches = (
            SurfaceTouches(self.avatar, names, RELEASE_MARGIN_M, self.parts) if names else None
        )

    def change(self, order: AvatarOrder) -> dict[str, float]:
        """Bring the body to the changes of an order; return the angle of each held axis."""
        try:
            self.avatar.switches.apply(ordered_settings(self._configured, order))
        except SimulationError as error:
            raise CannotChange(str(error)) from error
        return self.avatar.switches.held_rad

    def frame(self, t_s: float, pose: Pose, fingers: FloatArray | None = None) -> Pose:
        """Simulate up to this frame and return the body's pose."""
        hips_m = self._hips_scale * pose.root_position_m
        if self._began_s is None:
            self._began_s = t_s
            self._follower.start(hips_m, pose.rotations, fingers)
        followed = self._follower.frame(t_s - self._began_s, hips_m, pose.rotations, fingers)
        if fingers is not None:
            self.fingers = self.avatar.finger_rotations()
        return Pose(followed.state.root_position_m, followed.state.rotations)

    def place_of(self, effector: str) -> Vector:
        """Return where the simulated limb is at the last frame."""
        limb, tip_m = self._limbs[effector]
        data = self.avatar.data
        place = data.xpos[limb] + data.xmat[limb].reshape(3, 3) @ tip_m
        return cast("Vector", tuple(place.tolist()))

    def touches(self) -> tuple[Bools, Bools]:
        """Return touches, determined from the contacts of the simulation."""
        return no_touches(self.parts) if self._touches is None else self._touches.read()


_PAST_DISTAL = 1.15
"""From the wrist to the finger tip, over the distance to the last joint of the middle finger."""
_WITHOUT_FINGERS_M = 0.18
"""From the wrist to the finger tip of a hand that is modelled without fingers."""


def _limbs_of(model: mujoco.MjModel) -> dict[str, tuple[int, FloatArray]]:
    """Return, by hand and foot, its body and the place of the finger tip or ankle in its frame."""
    places = _t_pose_of(model)
    limbs: dict[str, tuple[int, FloatArray]] = {}
    for side, outwards in (("Left", -1.0), ("Right", 1.0)):
        hand, foot = f"{side}Hand", f"{side}Foot"
        if hand in places:
            end = places.get(f"{side}MiddleDistal")
            straight = np.array([outwards * _WITHOUT_FINGERS_M, 0.0, 0.0])
            tip_m = straight if end is None else _PAST_DISTAL * (end - places[hand])
            limbs[hand] = model.body(hand).id, tip_m
        if foot in places:
            limbs[foot] = model.body(foot).id, np.zeros(3)
    return limbs


def _t_pose_of(model: mujoco.MjModel) -> dict[str, FloatArray]:
    """Return the joints of a model's parts in the T-pose, in which frames are parallel."""
    places: dict[str, FloatArray] = {}
    for body in range(1, model.nbody):
        parent = model.body(model.body_parentid[body]).name
        places[model.body(body).name] = places.get(parent, np.zeros(3)) + model.body_pos[body]
    return places


def ordered_settings(configured: RunningSettings, order: AvatarOrder) -> RunningSettings:
    """Return the settings that an order asks for, with those of the configuration otherwise."""
    layers = set(configured.layers)
    for pair in order.layers:
        (layers.add if pair.collide else layers.discard)(frozenset(pair.layers))
    motors = {
        axis: replace(
            configured.axes[axis],
            kp=motor.kp_nm_per_rad,
            kd=motor.kd_nm_s_per_rad,
            max_torque_nm=motor.max_torque_nm,
        )
        for axis, motor in order.motors.items()
        if axis in configured.axes
    }
    return RunningSettings(
        gravity=configured.gravity if order.gravity is None else order.gravity,
        self_collision=(
            configured.self_collision if order.self_collision is None else order.self_collision
        ),
        colliders={**configured.colliders, **order.colliders},
        layers=frozenset(layers),
        held_rad=order.held_rad,
        axes={**configured.axes, **motors},
    )
