"""Simulated avatars for tests, and helpers that move them."""

import json
from dataclasses import dataclass
from functools import cache

import numpy as np

from app.protocol.avatar import parse_avatar_json
from app.protocol.humanoid import parse_figure
from app.resources import bodies_dir
from app.science.avatar.body.parts import AXES, AXIS_NAMES, FINGER_PARTS
from app.science.avatar.configuration.configuration import Configuration, Hips
from app.science.avatar.mjcf.gains import default_configuration
from app.science.avatar.mjcf.model import AvatarModel, avatar_model
from app.science.avatar.mjcf.scene import Scene, SceneBox
from app.science.avatar.simulation.following import Follower
from app.science.avatar.simulation.simulation import PhysicsAvatar
from app.science.avatar.targets.targets import TargetAngles, Targets
from app.science.rotations import FloatArray
from app.science.skeleton import Movement
from tests.science.avatar.captured import RATE_HZ, STATURE_M

EMPTY = Scene(floor=False)
EIGHT_BOXES = Scene(
    tuple(
        SceneBox(f"box/{number}", (-1.05 + 0.3 * number, 1.1, -0.5), (0.1, 0.1, 0.1))
        for number in range(8)
    )
)


@cache
def model(scene: Scene = EMPTY, *, hips: Hips = "carried", fingers: bool = False) -> AvatarModel:
    """Return an avatar model with the default configuration."""
    usual = default_configuration()
    axes = {
        axis.name: usual.axes[axis.name]
        for axis in AXES
        if fingers or axis.part not in FINGER_PARTS
    }
    return avatar_model(Configuration(axes, hips=hips), STATURE_M, scene=scene)


@cache
def standard_model(scene: Scene = EMPTY) -> AvatarModel:
    """Return the model of the shipped standard avatar: the neutral body with mesh colliders."""
    configuration = parse_avatar_json((bodies_dir() / "standard.json").read_text(encoding="utf-8"))
    measures = json.loads((bodies_dir() / "neutral.json").read_text(encoding="utf-8"))
    figure = parse_figure(measures["figure"])
    return avatar_model(configuration, STATURE_M, figure=figure, scene=scene)


def avatar(scene: Scene = EMPTY, *, hips: Hips = "carried", fingers: bool = False) -> PhysicsAvatar:
    """Return a simulated avatar in the T-pose."""
    return PhysicsAvatar(model(scene, hips=hips, fingers=fingers).mjcf)


def target_angles(built: AvatarModel) -> TargetAngles:
    """Return the converter from a participant's poses to the avatar's angles."""
    return TargetAngles(built.configuration.axes, built.body.parts)


def angles(**radians: float) -> FloatArray:
    """Return all 91 angles, zero except for those given by name."""
    found = np.zeros(len(AXIS_NAMES))
    for name, angle in radians.items():
        found[AXIS_NAMES.index(name)] = angle
    return found


def run(body: PhysicsAvatar, targets: FloatArray, count: int) -> None:
    """Command the same target angles for this many frames."""
    start_s = body.time_s
    for frame in range(1, count + 1):
        body.set_targets(targets)
        body.step_to(start_s + frame / RATE_HZ)


def angle_of(body: PhysicsAvatar, axis: str) -> float:
    """Return the current angle of one axis."""
    return float(body.state().angles_rad[AXIS_NAMES.index(axis)])


@dataclass(frozen=True, eq=False)
class Followed:
    """A followed movement of N frames, with its targets and the simulated body.

    `actual_rad` is (N, 91) with NaN where there is no hinge, `rotations` (N, 22, 4).
    """

    targets: Targets
    actual_rad: FloatArray
    rotations: FloatArray
    roots_m: FloatArray
    body: PhysicsAvatar

    def errors_deg(self) -> FloatArray:
        """Return the (N, driven axes) distances from the clamped command, in degrees."""
        errors = np.degrees(np.abs(self.actual_rad - self.targets.angles_rad))
        return errors[:, ~np.isnan(errors[0])]


def follow(built: AvatarModel, movement: Movement, *, delay_s: float = 0.0) -> Followed:
    """Let an avatar follow a movement frame by frame, starting in its first pose."""
    body = PhysicsAvatar(built.mjcf)
    follower = Follower(body, target_angles(built), delay_s=delay_s)
    follower.start(movement.root_positions_m[0], movement.rotations[0])
    states = [
        follower.frame(
            (frame + 1) / RATE_HZ, movement.root_positions_m[frame], movement.rotations[frame]
        ).state
        for frame in range(movement.frame_count)
    ]
    return Followed(
        target_angles(built).batch(movement.rotations),
        np.stack([state.angles_rad for state in states]),
        np.stack([state.rotations for state in states]),
        np.stack([state.root_position_m for state in states]),
        body,
    )
