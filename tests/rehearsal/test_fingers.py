"""Tests of rehearsals with generated fingers."""

import asyncio
from typing import cast

import numpy as np

from app.client.telemetry import TelemetryClient
from app.rehearsal.frame_clock import FrameClock
from app.rehearsal.headset import Headset
from app.science.avatar.mjcf import avatar_model, default_configuration, scene_of
from app.science.skeleton import FINGER_PARTS, finger_of
from app.simulated_people.avatars import PhysicsBody
from app.simulated_people.body import make_person
from app.wire.messages import ContactReport
from tests.protocol.helpers import study
from tests.rehearsal.orders import InstantServer, order
from tests.rehearsal.test_headset import AS_FAST_AS_IT_GOES


class BuiltWithFingers:
    """A connection that builds the avatar in this process, which is given fingers."""

    async def request_avatar(self, stature_m: float, body: str | None = None) -> PhysicsBody:
        """Return the avatar as the server would build it."""
        assert body is None
        configuration = default_configuration()
        scene = scene_of(tuple(study().tasks.layouts().values()))
        built = avatar_model(configuration, stature_m, scene=scene)
        return PhysicsBody(built.mjcf, configuration, with_fingers=True)


def play(physics: BuiltWithFingers | None) -> tuple[list[ContactReport], Headset]:
    """Run a hand phase with fingers."""
    server = InstantServer(order(limb="hand", kind="task", duration_s=12.0, latency_ms=0.0))
    person = make_person(np.random.default_rng(3), None, with_fingers=True)
    client = cast("TelemetryClient", server)
    headset = Headset(client, person, study().tasks, FrameClock(AS_FAST_AS_IT_GOES), physics)
    asyncio.run(headset.run())
    return [one for one in server.reports if isinstance(one, ContactReport)], headset


def test_a_physics_avatar_touches_panels_with_the_finger_that_points() -> None:
    """A body with fingers reports contacts by finger part, and panels by the index finger."""
    contacts, headset = play(BuiltWithFingers())
    panels = {one.body_part for one in contacts if one.effect == "green"}
    assert panels
    assert {finger_of(part) for part in panels} == {"Index"}
    assert {one.body_part for one in contacts} & set(FINGER_PARTS)
    assert headset.completions > 0
    assert len(set(headset.frames_sent.values())) == 1
    assert set(headset.frames_sent) == {"target", "actual", "target_fingers", "actual_fingers"}


def test_a_delayed_copy_touches_with_its_fingers_too() -> None:
    """A delayed copy with fingers also reports contacts by finger part."""
    contacts, headset = play(None)
    assert "RightIndexDistal" in {one.body_part for one in contacts if one.effect == "green"}
    assert headset.completions > 0
