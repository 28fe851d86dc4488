"""Where the scripted headset gets the physics avatar of its session."""

import asyncio
from dataclasses import dataclass
from typing import Protocol

from httpx2 import AsyncClient

from app.client import Json, call_with_retry
from app.protocol.avatar import AvatarFile, configuration_of
from app.science.skeleton import build_skeleton
from app.simulated_people.avatars import PhysicsBody


class AvatarSource(Protocol):
    """A source of the physics avatar of a session."""

    async def request_avatar(self, stature_m: float, body: str | None = None) -> PhysicsBody:
        """Return the avatar for a participant of this stature, with the body of this name.

        Without a name it has the body of the avatar's configuration.
        """


@dataclass(frozen=True)
class FromServer:
    """The avatar that the server builds and records.

    `http` sends as the session's paired headset. `with_fingers`: the participant's are given.
    """

    http: AsyncClient
    with_fingers: bool = False

    async def request_avatar(self, stature_m: float, body: str | None = None) -> PhysicsBody:
        """Return the avatar for a participant of this stature, with the body of this name.

        Raises the errors of `call_with_retry`.
        """
        answer: Json = await call_with_retry(
            self.http, "POST", "/api/vr/avatar", {"stature_m": stature_m, "body": body}
        )
        configuration = configuration_of(AvatarFile.model_validate(answer["configuration"]))
        # Loading the model and the compiled code takes a second or two.
        own_m = build_skeleton(stature_m).standing_hips_m
        scale = answer["standing_hips_m"] / own_m
        return await asyncio.to_thread(
            PhysicsBody, answer["mjcf"], configuration, scale, with_fingers=self.with_fingers
        )
