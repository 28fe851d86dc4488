"""A model of the avatar, random poses of it, and the goals of trackers in these poses."""

from functools import cache

import mujoco
import numpy as np

from app.science.avatar.body.body import build_body
from app.science.avatar.body.masses import body_masses
from app.science.avatar.configuration.model_options import ModelOptions
from app.science.avatar.ik import GOAL_PARTS, REST_POSE_RAD, Goals
from app.science.avatar.ik.chain import Chain
from app.science.avatar.mjcf.gains import default_settings
from app.science.avatar.mjcf.mjcf import build_mjcf
from app.science.avatar.mjcf.scene import Scene, SceneBox
from app.science.rotations import FloatArray, from_rotation_vector

STATURE_M, MASS_KG = 1.75, 72.0
WALLS = Scene(
    (
        SceneBox("front", (0.0, 1.4, -0.75), (0.9, 0.6, 0.02)),
        SceneBox("left", (-1.05, 1.4, 0.0), (0.02, 0.6, 0.6)),
        SceneBox("right", (1.05, 1.4, 0.0), (0.02, 0.6, 0.6)),
    )
)
"""A wall in front within reach of the hands, and one to each side just out of reach."""
STANDING_M = np.array((0.0, 0.95, 0.0))
UPRIGHT = np.array((1.0, 0.0, 0.0, 0.0))


@cache
def mjcf(*, welded: bool = False) -> str:
    """Return the MJCF of the whole body of 52 parts between three walls."""
    body = build_body(STATURE_M)
    masses = body_masses(body, MASS_KG)
    options = ModelOptions(hips="welded" if welded else "carried")
    return build_mjcf(body, masses, default_settings(body, masses), scene=WALLS, options=options)


@cache
def model(*, welded: bool = False) -> mujoco.MjModel:
    """Return the loaded model of the whole body; it is cached and must not be changed."""
    return mujoco.MjModel.from_xml_string(mjcf(welded=welded))


def random_pose(chain: Chain, rng: np.random.Generator, share: float = 0.6) -> FloatArray:
    """Return a random angle of every hinge, near the middle between rest and its range.

    `share` is the part of each range that is used.
    """
    rest = np.array([REST_POSE_RAD.get(name, 0.0) for name in chain.axis_names])
    pose = rest.copy()
    at = chain.moving
    low, high = chain.low_rad[at], chain.high_rad[at]
    middle = np.clip(rest[at], low + 0.25 * (high - low), high - 0.25 * (high - low))
    pose[at] = middle + share * 0.5 * (high - low) * rng.uniform(-0.5, 0.5, len(at))
    return pose


def reached(
    chain: Chain,
    angles_rad: FloatArray,
    hips_m: FloatArray = STANDING_M,
    hips: FloatArray = UPRIGHT,
    *,
    waist: bool = True,
) -> Goals:
    """Return the goals that this pose reaches exactly."""
    chain.place(hips_m, hips, angles_rad)
    count = len(GOAL_PARTS)
    tracked = np.ones(count, dtype=np.bool_)
    tracked[0] = waist
    return Goals(
        np.array([chain.position_m(row) for row in range(count)]),
        np.array([chain.rotation(row) for row in range(count)]),
        tracked,
    )


def turned_hips(yaw_rad: float) -> FloatArray:
    """Return the rotation of hips turned about the vertical by this yaw."""
    return from_rotation_vector(np.array((0.0, yaw_rad, 0.0)))


def smooth(fraction: float) -> float:
    """Return a smooth step from 0 to 1, with zero speed at both ends."""
    return fraction * fraction * (3.0 - 2.0 * fraction)
