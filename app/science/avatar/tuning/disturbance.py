"""Push a part of a body that holds a pose, and measure how it gives way and comes back.

The hips stay where they are and nothing is around, so what moves is the limb alone. The force acts
at the part's centre of mass, constant in the world, from `BEGIN_S` for a stated time. Deflection is
the angle of the part from its direction just before the push; it has returned when it stays within
`RETURNED_RAD` of that.
"""

from dataclasses import dataclass
from math import radians
from typing import Final

import numpy as np

from app.science.avatar.body import Figure
from app.science.avatar.configuration import Configuration, world_limbs
from app.science.avatar.mjcf import Scene, SimulationError, avatar_model
from app.science.rotations import FloatArray, Vector, geodesic_angle

BEGIN_S: Final = 1.0
RETURNED_RAD: Final = radians(2.0)
_EMPTY: Final = Scene(floor=False)
_HIPS_M: Final = (0.0, 1.0, 0.0)


@dataclass(frozen=True)
class Disturbance:
    """A push.

    Attributes:
        part: the body part that is pushed.
        force_n: the force in the world; the body faces -z, and +x is its right.
        duration_s: how long it lasts.
    """

    part: str
    force_n: Vector
    duration_s: float = 0.2


@dataclass(frozen=True, eq=False)
class Response:
    """What a push did, at the rate of the frames; the push begins in the first of the N frames.

    Attributes:
        times_s: (N,) since the push began.
        deflection_rad: (N,) by how much the part was turned.
        energy_j: (N,) kinetic energy of the body, and elastic energy of the motors' springs.
        peak_rad: the greatest deflection.
        return_s: time from the end of the push until the deflection stays below `RETURNED_RAD`;
            None if it does not.
        rest_rad: the deflection at the end.
        saturated_share: share of the frames with a motor at its torque limit.
        saturated: the axes whose motors were at their limits.
        restored: how often the simulation failed and was restored.
    """

    times_s: FloatArray
    deflection_rad: FloatArray
    energy_j: FloatArray
    peak_rad: float
    return_s: float | None
    rest_rad: float
    saturated_share: float
    saturated: tuple[str, ...]
    restored: int


def disturb(
    configuration: Configuration,
    stature_m: float,
    push: Disturbance,
    rotations: FloatArray,
    *,
    rate_hz: float = 90.0,
    watched_s: float = 2.5,
    figure: Figure | None = None,
) -> Response:
    """Push a body that follows a person who holds a pose.

    Args:
        configuration: the configuration of the body.
        stature_m: the stature of the body.
        push: what is pushed, and how.
        rotations: (22, 4) the pose, local rotations wxyz.
        rate_hz: frames per second.
        watched_s: time from the beginning of the push that is recorded.
        figure: the model that the configuration names.

    Raises:
        BodyError: the body cannot be built.
        SimulationError: the body has no such part.
    """
    import mujoco

    from app.science.avatar.simulation import Follower, PhysicsAvatar
    from app.science.avatar.targets import TargetAngles

    built = avatar_model(configuration, stature_m, figure=figure, scene=_EMPTY, longest_delay_s=0.0)
    if push.part not in built.body.parts:
        raise SimulationError(f"The body has no part {push.part!r} that could be pushed.")
    avatar = PhysicsAvatar(built.mjcf)
    follower = Follower(
        avatar,
        TargetAngles(configuration.in_force, built.body.parts),
        target_space=configuration.target_space,
        world_limbs=world_limbs(configuration.compliance),
    )
    hips_m = np.array(_HIPS_M)
    follower.start(hips_m, rotations)
    body = avatar.model.body(push.part).id
    first, last = round(BEGIN_S * rate_hz), round((BEGIN_S + push.duration_s) * rate_hz)
    frames = round((BEGIN_S + watched_s) * rate_hz)
    motors = configuration.motors
    stiffness = np.array([motors[name].kp for name in avatar.axis_names])
    before = np.empty(4)
    turned, energies, limited = [], [], []
    for frame in range(frames):
        pushed = first <= frame < last
        if frame == first:
            before = avatar.data.xquat[body].copy()
        avatar.data.xfrc_applied[body, :3] = push.force_n if pushed else (0.0, 0.0, 0.0)
        follower.frame((frame + 1) / rate_hz, hips_m, rotations)
        if frame < first:
            continue
        turned.append(float(geodesic_angle(before, avatar.data.xquat[body])))
        mujoco.mj_energyVel(avatar.model, avatar.data)
        stretched = avatar.stretched_rad()
        energies.append(avatar.data.energy[1] + float(np.sum(stiffness * stretched**2)) / 2.0)
        limited.append(avatar.saturated())
    return _response(
        np.array(turned), np.array(energies), limited, last - first, rate_hz, avatar.health.restored
    )


def returned_after_s(
    deflection_rad: FloatArray, pushed_frames: int, rate_hz: float
) -> float | None:
    """Return the time from the end of a push until its deflection stays within `RETURNED_RAD`.

    Args:
        deflection_rad: (N,) after each frame since the push began.
        pushed_frames: frames with the push; the first ones.
        rate_hz: frames per second.

    Returns:
        The time in seconds, 0 if the part had returned before the push ended; None if it has not.
    """
    beyond = np.flatnonzero(deflection_rad > RETURNED_RAD)
    last = int(beyond[-1]) + 1 if beyond.size else 0
    return None if last == len(deflection_rad) else max(last - pushed_frames, 0) / rate_hz


def _response(
    turned: FloatArray,
    energies: FloatArray,
    limited: list[tuple[str, ...]],
    pushed_frames: int,
    rate_hz: float,
    restored: int,
) -> Response:
    return Response(
        times_s=np.arange(1, len(turned) + 1, dtype=np.float64) / rate_hz,
        deflection_rad=turned,
        energy_j=energies,
        peak_rad=float(turned.max()),
        return_s=returned_after_s(turned, pushed_frames, rate_hz),
        rest_rad=float(turned[-1]),
        saturated_share=sum(map(bool, limited)) / len(limited),
        saturated=tuple(dict.fromkeys(name for names in limited for name in names)),
        restored=restored,
    )
