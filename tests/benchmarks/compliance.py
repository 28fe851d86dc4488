"""Push a shin and measure how it gives way and comes back; and what softness costs.

The body is the product's own, 1.75 m and 72 kg, with version 1 of the shipped configuration. It
stands on its right leg, with the left thigh raised by 30 degrees and the knee bent by 50; nothing
is around it. The left shin is pushed at its centre of mass for 0.2 s.

`push`: 50, 100 and 200 N from the front, and 200 N from the side, at 100, 10 and 3 % of the
stiffness, with joint targets and with world targets: the peak of the shin's deflection, the time
until it stays within 2 degrees again, and the share of the frames with a motor at its torque limit.
The peer of a figure with world targets is the one with joint targets. `worn`: the same for version
2, the neutral body with the gains that were tuned for it. `following`: how far a body
with soft limbs stays behind a walk, without a push; its peer is the stiff body.
"""

from collections.abc import Iterator
from dataclasses import replace
from math import cos, degrees, inf, radians, sin

from app.adapters.humanoids import read_humanoid
from app.features.movement.avatar.service import shipped_configurations
from app.science.avatar.body import Figure as BodyFigure
from app.science.avatar.body import figure_of
from app.science.avatar.configuration import LIMBS, Compliance, Configuration, LimbTargets
from app.science.avatar.mjcf import default_configuration
from app.science.avatar.tuning import Disturbance, Response, disturb, track
from app.science.retargeting import REFERENCE_JOINT_MAP, example_walk, movement_in_place
from app.science.rotations import FloatArray, Vector, identity
from app.science.skeleton import JOINT_INDEX, build_skeleton, resample
from tests.benchmarks.report import Figure, Report
from tests.support.bodies_page import BODY

PARTS = ("push", "worn", "following")
STATURE_M, RATE_HZ = 1.75, 90.0
STIFFNESSES = (1.0, 0.1, 0.03)
TARGETS: tuple[LimbTargets, ...] = ("joint", "world")
PUSHES: tuple[tuple[str, float, Vector], ...] = (
    ("50 N", 50.0, (0.0, 0.0, 1.0)),
    ("100 N", 100.0, (0.0, 0.0, 1.0)),
    ("200 N", 200.0, (0.0, 0.0, 1.0)),
    ("200 N sideways", 200.0, (1.0, 0.0, 0.0)),
)


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts; their duration cannot be chosen."""
    report = Report("compliance")
    if "push" in parts:
        report.add(*_pushes("push", default_configuration(), None))
    if "worn" in parts:
        figure = figure_of(read_humanoid(BODY.read_bytes()).humanoid)
        report.add(*_pushes("worn", shipped_configurations()[-1], figure))
    if "following" in parts:
        report.add(*_following())
    return report


def _pushes(part: str, body: Configuration, figure: BodyFigure | None) -> Iterator[Figure]:
    restored = not_finite = 0
    for name, force_n, direction in PUSHES:
        push = pushed_shin(force_n, direction)
        for stiffness in STIFFNESSES:
            joint, world = (
                pushed(body, figure, Compliance(stiffness, targets), push) for targets in TARGETS
            )
            case = f"{name}, {100 * stiffness:g} % stiff"
            yield from _compared(part, f"{case}, peak", "deg", _peak_deg(joint), _peak_deg(world))
            yield from _compared(part, f"{case}, return", "s", _return_s(joint), _return_s(world))
            for response in (joint, world):
                restored += response.restored
                not_finite += not all(map(_finite, response.energy_j.tolist()))
            shares = 100 * joint.saturated_share, 100 * world.saturated_share
            yield from _compared(part, f"{case}, at the torque limit", "%", *shares)
    yield Figure(part, "resets", float(restored), "", "at most", 0.0)
    yield Figure(part, "runs that are not finite", float(not_finite), "", "at most", 0.0)


def _compared(part: str, name: str, unit: str, joint: float, world: float) -> Iterator[Figure]:
    yield Figure(part, f"{name}, joint targets", joint, unit)
    yield Figure(part, f"{name}, world targets", world, unit, "joint targets", joint)


def pushed_shin(force_n: float, direction: Vector) -> Disturbance:
    """Return a push of the left shin by so many newtons along a unit vector in the world."""
    x, y, z = direction
    return Disturbance("LeftLowerLeg", (force_n * x, force_n * y, force_n * z))


def pushed(
    body: Configuration, figure: BodyFigure | None, leg: Compliance, push: Disturbance
) -> Response:
    """Push a shin of a body with a left leg that gives way as stated."""
    soft = replace(body, compliance={"left_leg": leg})
    return disturb(soft, STATURE_M, push, _step(), figure=figure)


def _step() -> FloatArray:
    pose = identity(len(JOINT_INDEX))
    for part, turn_deg in (("LeftUpperLeg", 30.0), ("LeftLowerLeg", -50.0)):
        half = radians(turn_deg) / 2.0
        pose[JOINT_INDEX[part]] = (cos(half), sin(half), 0.0, 0.0)
    return pose


def _peak_deg(response: Response) -> float:
    return degrees(response.peak_rad)


def _return_s(response: Response) -> float:
    return inf if response.return_s is None else response.return_s


def _finite(value: float) -> bool:
    return abs(value) < inf


def _following() -> Iterator[Figure]:
    skeleton = build_skeleton(STATURE_M)
    walk = resample(movement_in_place(example_walk(), REFERENCE_JOINT_MAP, skeleton), RATE_HZ)
    stiff = track(default_configuration(), STATURE_M, walk)
    for stiffness in STIFFNESSES:
        for targets in TARGETS:
            compliance = dict.fromkeys(LIMBS, Compliance(stiffness, targets))
            soft = replace(default_configuration(), compliance=compliance)
            found = track(soft, STATURE_M, walk)
            case = f"walk, {100 * stiffness:g} % stiff, {targets} targets"
            for what in ("mean", "p95"):
                value, peer = getattr(found, f"{what}_deg"), getattr(stiff, f"{what}_deg")
                yield Figure("following", f"{case}, {what}", value, "deg", "stiff", peer)
