"""The remote avatar of the scripted headset: a delayed copy, or a body that follows by forces."""

import asyncio
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from httpx2 import AsyncClient
from numpy.typing import NDArray

from app.client import Json, call_again
from app.protocol.avatar import AvatarFile, configuration_of
from app.science.avatar.configuration import Configuration
from app.science.avatar.simulation import Follower, PhysicsAvatar, SurfaceTouches
from app.science.avatar.targets import TargetAngles
from app.science.delay import DelayBuffer
from app.science.skeleton import (
    Pose,
    Skeleton,
    body_part_segments,
    build_skeleton,
    forward_kinematics,
)
from app.science.tasks import SurfaceArrays, TaskLayout, touching_and_near

FloatArray = NDArray[np.float64]
Bools = NDArray[np.bool_]
RELEASE_MARGIN_M = 0.005
"""How far a part may go from a surface before its touch is over."""


class RemoteAvatar(Protocol):
    """The body that the participant sees as theirs."""

    def set_latency(self, latency_s: float) -> None:
        """Follow so much later from now on."""

    def show_boxes(self, layout: TaskLayout | None) -> None:
        """Put the boxes of a task into the room, or take all away."""

    def frame(self, t_s: float, pose: Pose) -> Pose:
        """Where the avatar is when the participant is in this pose, frame after frame."""

    def touches(self) -> tuple[Bools, Bools]:
        """What it touches at the last frame, and what is near enough to hold a touch.

        Two bool (S, 22), surfaces of the task by joints of the skeleton; (0, 22) without boxes.
        """


class DelayedCopy:
    """The participant's own movement, with every joint but the hips delayed."""

    def __init__(self, skeleton: Skeleton) -> None:
        self._skeleton, self._delay = skeleton, DelayBuffer(0.0)
        self._surfaces: SurfaceArrays | None = None
        self._pose: Pose | None = None

    def set_latency(self, latency_s: float) -> None:
        """Follow so much later from now on."""
        self._delay.set_delay(latency_s)

    def show_boxes(self, layout: TaskLayout | None) -> None:
        """What is judged from now on; a copy passes through everything."""
        self._surfaces = None if layout is None else SurfaceArrays.of(layout)

    def frame(self, t_s: float, pose: Pose) -> Pose:
        """The hips as they are, the joints as they were."""
        self._pose = Pose(pose.root_position_m, self._delay.push(t_s, pose.rotations))
        return self._pose

    def touches(self) -> tuple[Bools, Bools]:
        """By the distances of the body's capsules from the boxes."""
        if self._surfaces is None or self._pose is None:
            return no_touches()
        world = forward_kinematics(self._skeleton, self._pose.root_position_m, self._pose.rotations)
        parts = body_part_segments(self._skeleton, world)
        return touching_and_near(self._surfaces, parts.axes_m, parts.radii_m, RELEASE_MARGIN_M)


def no_touches() -> tuple[Bools, Bools]:
    """Nothing to touch."""
    nothing = np.zeros((0, 22), dtype=np.bool_)
    return nothing, nothing


class AvatarSource(Protocol):
    """Where the avatar of a session is had from."""

    async def take_up(self, stature_m: float) -> "PhysicsBody":
        """The avatar for a participant of this stature."""


@dataclass(frozen=True)
class FromServer:
    """The server builds and records it; `http` calls as the session's paired headset."""

    http: AsyncClient

    async def take_up(self, stature_m: float) -> "PhysicsBody":
        """The avatar for a participant of this stature; raises as `call_again`."""
        told: Json = await call_again(self.http, "POST", "/api/vr/avatar", {"stature_m": stature_m})
        configuration = configuration_of(AvatarFile.model_validate(told["configuration"]))
        # Loading the model and the compiled code takes a second or two.
        own_m = build_skeleton(stature_m).standing_hips_m
        scale = told["standing_hips_m"] / own_m
        return await asyncio.to_thread(PhysicsBody, told["mjcf"], configuration, scale)


class PhysicsBody:
    """A simulated body that stands where the participant's first pose is, without boxes.

    Args:
        mjcf: the model, with the boxes of all tasks.
        configuration: that the model was built from.
        hips_scale: how high its hips are when it stands, as a share of the participant's.
    """

    def __init__(self, mjcf: str, configuration: Configuration, hips_scale: float = 1.0) -> None:
        self._hips_scale = np.array([1.0, hips_scale, 1.0])
        self.avatar = PhysicsAvatar(mjcf)
        self.avatar.boxes.show(())
        angles = TargetAngles(configuration.in_force, self.avatar.parts)
        self._follower = Follower(self.avatar, angles, target_space=configuration.target_space)
        self._touches: SurfaceTouches | None = None
        self._began_s: float | None = None

    def set_latency(self, latency_s: float) -> None:
        """Let the motors' targets come so much later from now on."""
        self._follower.set_delay(latency_s)

    def show_boxes(self, layout: TaskLayout | None) -> None:
        """Put the boxes of a task into the room, or take all away."""
        names = () if layout is None else tuple(surface.key for surface in layout.surfaces)
        self.avatar.boxes.show(names)
        self._touches = SurfaceTouches(self.avatar, names, RELEASE_MARGIN_M) if names else None

    def frame(self, t_s: float, pose: Pose) -> Pose:
        """Simulate up to this frame; where the body is then."""
        hips_m = self._hips_scale * pose.root_position_m
        if self._began_s is None:
            self._began_s = t_s
            self._follower.start(hips_m, pose.rotations)
        followed = self._follower.frame(t_s - self._began_s, hips_m, pose.rotations)
        return Pose(followed.state.root_position_m, followed.state.rotations)

    def touches(self) -> tuple[Bools, Bools]:
        """By the contacts of the simulation."""
        return no_touches() if self._touches is None else self._touches.read()
