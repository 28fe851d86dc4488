"""Generate the movement of a person standing idle, used when there is no capture.

Each joint swings about a relaxed pose by a few slow sinusoids of seeded phase: breathing in the
chest at about 0.25 Hz, sway of the hips below 0.5 Hz, small movements of head and arms. Frequencies
are whole multiples of 1 / duration, so the movement loops seamlessly. The amplitudes are our own
assumption: small enough to look alive, not a model of balance.
"""

import numpy as np

from app.science.rotations import FloatArray, from_rotation_vector, multiply
from app.science.skeleton import JOINT_COUNT, JOINT_INDEX, Movement, Skeleton, continuous

_SWAY_HZ = (0.11, 0.23, 0.41)
_BREATH_HZ = 0.25
_BREATH_RAD = 0.012
_SWAY_M = 0.006
# Standard deviation of each joint's swing in degrees; joints that are not listed stay still.
_SWING_DEG = {
    "Hips": 0.6,
    "Spine": 0.5,
    "Chest": 0.5,
    "UpperChest": 0.4,
    "Neck": 1.5,
    "Head": 2.0,
    "LeftUpperArm": 1.5,
    "RightUpperArm": 1.5,
    "LeftLowerArm": 2.0,
    "RightLowerArm": 2.0,
    "LeftHand": 2.0,
    "RightHand": 2.0,
}


def idle_movement(
    skeleton: Skeleton, rng: np.random.Generator, *, duration_s: float = 30.0, rate_hz: float = 90.0
) -> Movement:
    """Generate a looping movement of a person who stands and waits, facing -z at the origin."""
    frames = max(2, round(duration_s * rate_hz))
    phase = 2.0 * np.pi * np.arange(frames) / frames
    vectors = np.zeros((frames, JOINT_COUNT, 3))
    for name, swing_deg in _SWING_DEG.items():
        for axis in range(3):
            swing = np.radians(swing_deg) * _swings(phase, duration_s, rng)
            vectors[:, JOINT_INDEX[name], axis] = swing
    breath = np.sin(_turns(_BREATH_HZ, duration_s) * phase + rng.uniform(0.0, 2.0 * np.pi))
    vectors[:, JOINT_INDEX["Chest"], 0] += _BREATH_RAD * breath
    root = np.tile(np.array((0.0, skeleton.standing_hips_m, 0.0)), (frames, 1))
    for axis in (0, 2):
        root[:, axis] += _SWAY_M * _swings(phase, duration_s, rng)
    rotations = multiply(relaxed_pose(), from_rotation_vector(vectors))
    return Movement(rate_hz, root, continuous(rotations), loops=True)


def relaxed_pose() -> FloatArray:
    """Return local rotations (22, 4) of a person who stands with the arms hanging down."""
    vectors = np.zeros((JOINT_COUNT, 3))
    for name, side in (("Left", 1.0), ("Right", -1.0)):
        vectors[JOINT_INDEX[f"{name}UpperArm"], 2] = side * np.radians(78.0)
        vectors[JOINT_INDEX[f"{name}LowerArm"], 1] = -side * np.radians(18.0)
    return from_rotation_vector(vectors)


def _turns(frequency_hz: float, duration_s: float) -> int:
    return max(1, round(frequency_hz * duration_s))


def _swings(phase: FloatArray, duration_s: float, rng: np.random.Generator) -> FloatArray:
    """Return a sum of slow sinusoids with standard deviation 1."""
    total = np.zeros_like(phase)
    for frequency in _SWAY_HZ:
        total += np.sin(_turns(frequency, duration_s) * phase + rng.uniform(0.0, 2.0 * np.pi))
    scaled: FloatArray = total * np.sqrt(2.0 / len(_SWAY_HZ))
    return scaled
