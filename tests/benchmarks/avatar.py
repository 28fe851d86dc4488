"""Measure how much faster than real time the avatar runs, and what its control costs.

`speed` lets an avatar with the product's own settings swing its limbs next to the eight boxes of a
study, frame by frame at 90 Hz, without fingers, with them, and as the standard avatar with mesh
colliders, whose fingers rest or follow generated ones, and measures the seconds simulated in one
second, compared with bare `mj_step` of the same model on the same inputs in the same run. The
difference is our own code: converting poses to angles, setting targets at every step, moving the
hips, watching contacts, reading the body back; at least 0.8 of the bare rate must remain. Time is
processor time, the two run in pairs, and the median ratio of the quickest third of the pairs
counts, so that other programs on the machine affect the result as little as possible. `control` is
one such frame without any simulation: a pose converted to angles, and the body converted to joints.
Rates of the other parts are those of the fastest round.

`bullet` is PyBullet with the same body, boxes and inputs (`peers.bullet_body` describes the
differences): with its defaults, 50 solver iterations and targets at every step as ours, and with 10
and targets once per frame; the figures also contain the distance of both bodies from their targets.
`humanoid` is each engine's own humanoid model, limp: MuJoCo's if the shared data are available.
PyBullet is installed on first use, and left out if that fails.
"""

import time
from collections.abc import Callable, Iterator
from functools import cache
from statistics import median
from typing import Literal

import mujoco
import numpy as np

from app.science.avatar.body import AXIS_NAMES
from app.science.avatar.mjcf import AvatarModel
from app.science.avatar.simulation import Follower, PhysicsAvatar
from app.science.rotations import FloatArray, from_rotation_vector
from app.science.simulation import SimulatedFingers
from app.science.skeleton import JOINT_COUNT
from tests.benchmarks.clips import shared_file
from tests.benchmarks.peers.bullet import bullet_avatar, bullet_humanoid_steps_per_s
from tests.benchmarks.report import Figure, Report
from tests.science.avatar.captured import RATE_HZ
from tests.science.avatar.simulated import EIGHT_BOXES, model, standard_model, target_angles

Kind = Literal["plain", "fingers", "mesh", "driven"]
KINDS: tuple[Kind, ...] = ("plain", "fingers", "mesh", "driven")
PARTS = ("speed", "control", "bullet", "humanoid")
ROUNDS, FRAMES, CALLS = 21, 270, 2000
BULLET_ROUNDS, HUMANOID_STEPS, HUMANOID_STEP_S = 5, 5000, 0.002
HIPS_M = np.array([0.0, 0.954, 0.0])
SWING_RAD, SWING_HZ = 0.35, 1.0


def measure(parts: frozenset[str], duration_s: float | None = None) -> Report:
    """Measure the named parts; `duration_s` has no effect."""
    report = Report("avatar")
    if "speed" in parts:
        for kind in KINDS:
            report.add(_speed(kind=kind))
    if "control" in parts:
        report.add(*_control())
    if "bullet" in parts:
        for kind in KINDS[:2]:
            report.add(*_beside_bullet(kind=kind))
    if "humanoid" in parts:
        report.add(*_humanoids())
    return report


def _speed(*, kind: Kind) -> Figure:
    """Return the bare rate and, by the median ratio, ours, of the quickest third of the pairs.

    Both of a pair run within a second, in alternating order, so that a program that slows the
    machine down for a while slows both. It slows Python more than compiled code, because it takes
    the caches, so only the pairs count that were disturbed least.
    """
    pairs = []
    for number in range(ROUNDS):
        if number % 2:
            ours_s = _followed_s(kind=kind)
            bare_s = _bare_s(kind=kind)
        else:
            bare_s = _bare_s(kind=kind)
            ours_s = _followed_s(kind=kind)
        pairs.append((ours_s, bare_s))
    told, quiet = _told(kind=kind), sorted(pairs, key=sum)[: ROUNDS // 3]
    bare = FRAMES / RATE_HZ / median(bare_s for _, bare_s in quiet)
    ours = bare * median(bare_s / ours_s for ours_s, bare_s in quiet)
    return Figure("speed", f"{told}, 8 boxes", ours, "x real time", "bare mj_step", bare)


def _followed_s(*, kind: Kind) -> float:
    (body, follower), poses, hands = _started(_model(kind)), _poses(), _hands(kind)
    start_s = time.process_time()
    for frame in range(FRAMES):
        given = hands[frame]
        follower.frame((frame + 1) / RATE_HZ, HIPS_M, poses[frame], given)
        if given is not None:
            body.finger_rotations()
    return time.process_time() - start_s


def _bare_s(*, kind: Kind) -> float:
    """Return the processor time of bare `mj_step` on the same steps, model and targets."""
    built = _model(kind)
    inputs = _inputs(built, kind=kind)
    body = _started(built)[0]
    step, bare, data = mujoco.mj_step, body.model, body.data
    start_s = time.process_time()
    for controls in inputs:
        data.ctrl[:] = controls
        step(bare, data)
    return time.process_time() - start_s


@cache
def _recorded(*, kind: Kind) -> FloatArray:
    """Return (FRAMES + 1, n) commands: the one at the beginning, and one at each frame's end."""
    built = _model(kind)
    body, follower = _started(built)
    poses, hands = _poses(), _hands(kind)
    states = [body.state()]
    states += [
        follower.frame((frame + 1) / RATE_HZ, HIPS_M, poses[frame], hands[frame]).state
        for frame in range(FRAMES)
    ]
    columns = [AXIS_NAMES.index(name) for name in body.axis_names]
    return np.stack([state.command_rad[columns] for state in states])


def _inputs(built: AvatarModel, *, kind: Kind) -> FloatArray:
    """Return (steps, nu) motor inputs for each step, interpolated between commands."""
    commands = _recorded(kind=kind)
    body = PhysicsAvatar(built.mjcf)
    step_s = body.model.opt.timestep
    ends = np.round(np.arange(FRAMES + 1) / RATE_HZ / step_s)
    passed = np.arange(int(ends[-1])) + 0.5
    frames = np.searchsorted(ends, passed) - 1
    slopes = np.diff(commands, axis=0) / np.diff(ends)[:, np.newaxis]
    angles = commands[frames] + slopes[frames] * (passed - ends[frames])[:, np.newaxis]
    return np.stack((angles, slopes[frames] / step_s), axis=-1).reshape(len(passed), -1)


def _started(built: AvatarModel) -> tuple[PhysicsAvatar, Follower]:
    body = PhysicsAvatar(built.mjcf)
    follower = Follower(body, target_angles(built))
    follower.start(HIPS_M, _poses()[0])
    return body, follower


def _poses() -> FloatArray:
    """Return (FRAMES, 22, 4) rotations in which every joint swings about an axis of its own."""
    rng = np.random.default_rng(1)
    axes = rng.normal(size=(JOINT_COUNT, 3))
    axes /= np.linalg.norm(axes, axis=1, keepdims=True)
    phase = rng.uniform(0.0, 2.0 * np.pi, JOINT_COUNT)
    turned = 2.0 * np.pi * SWING_HZ * np.arange(FRAMES)[:, np.newaxis] / RATE_HZ + phase
    vectors = SWING_RAD * np.sin(turned)[..., np.newaxis] * axes
    vectors[:, 0] = 0.0
    return from_rotation_vector(vectors)


def _beside_bullet(*, kind: Kind) -> Iterator[Figure]:
    built = _model(kind)
    body = PhysicsAvatar(built.mjcf)
    controls = _inputs(built, kind=kind)
    steps = round(1.0 / RATE_HZ / body.model.opt.timestep)
    peers = bullet_avatar(body.model, controls, steps_per_frame=steps, rounds=BULLET_ROUNDS)
    if not peers:
        return
    told, simulated_s = _told(kind=kind), FRAMES / RATE_HZ
    ours = simulated_s / min(_followed_s(kind=kind) for _ in range(BULLET_ROUNDS))
    error = _mean_error_deg(body, controls)
    for peer in peers:
        rate = simulated_s / peer.fastest_s
        yield Figure("bullet", f"{told}, 8 boxes", ours, "x real time", peer.name, rate)
        name = f"{told}: error of the axes, mean"
        yield Figure("bullet", name, error, "deg", peer.name, peer.mean_error_deg)


def _mean_error_deg(body: PhysicsAvatar, controls: FloatArray) -> float:
    """Return the mean error of all axes from their targets, leaving out the first sixth."""
    data, errors = body.data, []
    data.qpos[:] = controls[0, 0::2]
    for row in controls:
        data.ctrl[:] = row
        mujoco.mj_step(body.model, data)
        errors.append(np.mean(np.abs(data.qpos - row[0::2])))
    return float(np.degrees(np.mean(errors[len(errors) // 6 :])))


def _humanoids() -> Iterator[Figure]:
    theirs = bullet_humanoid_steps_per_s(HUMANOID_STEP_S, HUMANOID_STEPS, BULLET_ROUNDS)
    beside = "" if theirs is None else "PyBullet's own humanoid"
    path = shared_file("models", "humanoid.xml")
    if path is None:
        return
    humanoid = mujoco.MjModel.from_xml_path(str(path))
    humanoid.opt.timestep = HUMANOID_STEP_S
    rounds = [_limp_s(humanoid) for _ in range(BULLET_ROUNDS)]
    ours = HUMANOID_STEPS / min(rounds)
    yield Figure("humanoid", "MuJoCo's own humanoid, limp", ours, "steps/s", beside, theirs)


def _limp_s(humanoid: mujoco.MjModel) -> float:
    data = mujoco.MjData(humanoid)
    start_s = time.process_time()
    for _ in range(HUMANOID_STEPS):
        mujoco.mj_step(humanoid, data)
    return time.process_time() - start_s


def _told(*, kind: Kind) -> str:
    return {
        "plain": "without fingers",
        "fingers": "52 parts",
        "mesh": "52 parts, mesh colliders",
        "driven": "52 parts, mesh colliders, fingers driven",
    }[kind]


def _model(kind: Kind) -> AvatarModel:
    if kind in ("mesh", "driven"):
        return standard_model(EIGHT_BOXES)
    return model(EIGHT_BOXES, fingers=kind == "fingers")


@cache
def _hands(kind: Kind) -> list[FloatArray | None]:
    """Return the generated rotations of all finger parts in each frame, None if they rest."""
    if kind != "driven":
        return [None] * FRAMES
    hands = SimulatedFingers(np.random.default_rng(1))
    return [hands.pose(frame / RATE_HZ) for frame in range(FRAMES)]


def _control() -> Iterator[Figure]:
    built = model(EIGHT_BOXES, fingers=True)
    body, angles, pose = PhysicsAvatar(built.mjcf), target_angles(built), _poses()[40]
    yield Figure("control", "pose to angles", _call_us(lambda: angles.follow(pose)), "us")
    yield Figure("control", "body read back", _call_us(body.state), "us")
    yield Figure("control", "contacts", _call_us(body.contacts), "us")


def _call_us(call: Callable[[], object]) -> float:
    call()
    start_s = time.process_time()
    for _ in range(CALLS):
        call()
    return 1e6 * (time.process_time() - start_s) / CALLS
