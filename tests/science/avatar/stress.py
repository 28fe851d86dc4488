"""Stress scenarios of the avatar: a fast hand against a wall, random poses and teleports."""

import math
from dataclasses import dataclass

import numpy as np

from app.science.avatar.body.parts import AXES
from app.science.avatar.configuration.configuration import Hips
from app.science.avatar.mjcf.scene import Scene, SceneBox
from app.science.avatar.simulation.simulation import PhysicsAvatar
from app.science.rotations import normalise
from tests.science.avatar.captured import RATE_HZ, STATURE_M
from tests.science.avatar.simulated import EIGHT_BOXES, angles, avatar

STEP_S = 0.002
_WALL = SceneBox("wall", (-0.8, 1.4, -0.31), (0.5, 0.6, 0.01))
WALL_FACE_M = -0.31
"""Middle of the wall along z, in metres; the hand approaches from larger z."""


@dataclass(frozen=True)
class WallImpact:
    """The result of driving a hand into a wall.

    Attributes:
        speed_m_s: speed of the hand just before it touched.
        deepest_m: greatest penetration of the wall.
        farthest_m: farthest position of the middle of the hand along z.
        touched: names of what was touched.
        least_force_n: smallest force of all contacts.
    """

    speed_m_s: float
    deepest_m: float
    farthest_m: float
    touched: frozenset[str]
    least_force_n: float


def swing_into_a_wall() -> WallImpact:
    """Swing the left arm into a wall of 2 cm at 2 m/s at the hand, and keep pressing."""
    body = avatar(Scene((_WALL,), floor=False))
    hand = body.model.geom("LeftHand/0").id
    reach_m = abs(body.data.geom_xpos[hand][0]) - 0.129 * STATURE_M
    deepest_m, fastest, farthest_m, before_m, least_n = 0.0, 0.0, 0.0, 0.0, math.inf
    touched: set[str] = set()
    for step in range(1, 600):
        swing = min(step * STEP_S * 2.0 / reach_m, 1.5)
        body.set_targets(angles(LeftUpperArmY=swing))
        body.step_to(step * STEP_S)
        for contact in body.contacts():
            deepest_m = max(deepest_m, contact.penetration_m)
            least_n = min(least_n, contact.force_n)
            touched.add(contact.other)
        place_m = float(body.data.geom_xpos[hand][2])
        if not touched:
            fastest = max(fastest, (before_m - place_m) / STEP_S)
        before_m, farthest_m = place_m, min(farthest_m, place_m)
    return WallImpact(fastest, deepest_m, farthest_m, frozenset(touched), least_n)


@dataclass(frozen=True, eq=False)
class RandomPosesRun:
    """The result of random poses: the body, and whether its angles were always finite."""

    body: PhysicsAvatar
    always_finite: bool


def run_random_poses(hips: Hips, jumps: int, every: int) -> RandomPosesRun:
    """Command random poses, and teleport the hips by up to 10 m in every `every`-th frame."""
    rng = np.random.default_rng(6)
    body = avatar(EIGHT_BOXES, hips=hips, fingers=True)
    finite = True
    for frame in range(1, jumps + 1):
        if frame % every == 0:
            place = rng.uniform((-10.0, 0.0, -10.0), (10.0, 2.0, 10.0))
            body.set_hips(place, normalise(rng.normal(size=4)))
        body.set_targets(rng.uniform(-math.pi, math.pi, len(AXES)))
        body.step_to(frame / RATE_HZ)
        finite = finite and bool(np.isfinite(body.data.qpos).all())
    return RandomPosesRun(body, finite)
