"""Tests of a rehearsal in which the participant changes bodies between blocks."""

import asyncio
from typing import Any, cast

import numpy as np
import pytest

from app.client.telemetry import TelemetryClient
from app.rehearsal.frame_clock import FrameClock
from app.rehearsal.headset import Headset
from app.science.avatar.mjcf import avatar_model, default_configuration, scene_of
from app.science.rotations import identity
from app.science.skeleton import Pose, build_skeleton
from app.simulated_people.avatars import PhysicsBody
from app.simulated_people.body import make_person
from tests.protocol.helpers import study
from tests.rehearsal.orders import InstantServer, order
from tests.rehearsal.test_headset import AS_FAST_AS_IT_GOES


class Wardrobe:
    """A connection that builds a body of another stature under each name, and counts them."""

    def __init__(self) -> None:
        self.built: dict[str | None, PhysicsBody] = {}

    async def request_avatar(self, stature_m: float, body: str | None = None) -> PhysicsBody:
        """Return the avatar as the server would build it."""
        configuration = default_configuration()
        scene = scene_of(tuple(study().tasks.layouts().values()))
        taller_m = {None: 0.0, "tall": 0.1, "taller": 0.2}[body]
        built = avatar_model(configuration, stature_m + taller_m, scene=scene)
        self.built[body] = PhysicsBody(built.mjcf, configuration)
        return self.built[body]


class Welcome:
    """The part of a welcome that names the study's bodies."""

    bodies = ("tall", "taller")
    on_disconnect = "pause"


def test_the_headset_wears_the_body_of_its_phase() -> None:
    """All bodies are requested at once; the one that the phase names follows the participant."""
    server: Any = InstantServer(order(limb="hand", kind="task", duration_s=2.0, body="tall"))
    server.welcome = Welcome()
    wardrobe = Wardrobe()
    person = make_person(np.random.default_rng(3), None)
    client = cast("TelemetryClient", server)
    headset = Headset(client, person, study().tasks, FrameClock(AS_FAST_AS_IT_GOES), wardrobe)
    asyncio.run(headset.run())
    assert list(wardrobe.built) == [None, "tall", "taller"]
    simulated_s = {body: one.avatar.time_s for body, one in wardrobe.built.items()}
    assert simulated_s["tall"] > 2.0
    assert simulated_s["taller"] == 0.0


def test_a_body_that_is_put_on_again_begins_at_rest() -> None:
    """A body that was not worn for a minute begins in the participant's pose, without catching up.

    Its clock begins anew, and it follows the participant from there.
    """
    built = avatar_model(default_configuration(), 1.7)
    body = PhysicsBody(built.mjcf, default_configuration())
    standing = build_skeleton(1.7).standing_hips_m
    pose = Pose(np.array([0.0, standing, 0.0]), identity(22))
    for frame in range(90):
        body.frame(frame / 90, pose)
    body.put_on()
    elsewhere = Pose(np.array([0.5, standing, 0.2]), identity(22))
    shown = body.frame(61.0, elsewhere)
    assert shown.root_position_m == pytest.approx(elsewhere.root_position_m, abs=1e-3)
    assert body.avatar.time_s == pytest.approx(0.0, abs=0.02)
    for frame in range(90):
        shown = body.frame(61.0 + frame / 90, elsewhere)
    assert body.avatar.time_s == pytest.approx(89 / 90, abs=0.02)
    assert shown.root_position_m == pytest.approx(elsewhere.root_position_m, abs=1e-3)
    assert np.abs(shown.rotations[:, 0]).min() > 0.99
