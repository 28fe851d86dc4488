"""The avatar that follows by forces, as the server built it for this participant."""

import asyncio
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from httpx2 import AsyncClient

from app.client.http import Json, call_again
from app.protocol.avatar import AvatarFile, configuration_of
from app.rehearsal.avatars import RELEASE_MARGIN_M, Bools, no_touches
from app.science.avatar.configuration import Configuration
from app.science.avatar.simulation import Follower, PhysicsAvatar, SurfaceTouches
from app.science.avatar.targets import TargetAngles
from app.science.skeleton import Pose, build_skeleton
from app.science.tasks import TaskLayout


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
