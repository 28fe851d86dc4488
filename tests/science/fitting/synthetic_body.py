"""A synthetic person of known bones and rotations, with markers where the fit assumes them."""

from dataclasses import dataclass

import numpy as np

from app.science.fitting.lower_body import ANKLE_HALF_WIDTH, KNEE_HALF_WIDTH
from app.science.fitting.upper_body import ELBOW_HALF_WIDTH, INNER_SHOULDER, SHOULDER_DROP
from app.science.rig import BodyMotion, MarkerMotion, Rig, RigMotion
from app.science.rotations import (
    FloatArray,
    from_rotation_vector,
    identity,
    multiply,
    normalise,
    rotate,
)

RATE_HZ = 100.0
WIDTH, DEPTH = 0.24, 0.15
"""Width and depth of the pelvis, in metres."""
_FRONT = np.array((0.0, 0.30 * WIDTH + 0.0109, -(0.24 * DEPTH + 0.0099)))
_HIP_X = 0.33 * WIDTH + 0.0073
_THIGH, _SHANK, _UPPER_ARM, _FOREARM, _SHOULDER = 0.43, 0.41, 0.29, 0.26, 0.18
_TREE: dict[str, tuple[str, tuple[float, float, float]]] = {
    "Spine": ("Hips", (0.0, _FRONT[1], _FRONT[2] + 0.6 * DEPTH)),
    "UpperChest": ("Spine", (0.0, 0.26, 0.0)),
    "Neck": ("UpperChest", (0.0, 0.2, 0.0)),
    "Head": ("Neck", (0.0, 0.08, 0.0)),
}
for _side, _sign in (("Left", -1.0), ("Right", 1.0)):
    _TREE |= {
        f"{_side}Shoulder": ("UpperChest", (_sign * INNER_SHOULDER * _SHOULDER, 0.2, 0.0)),
        f"{_side}UpperArm": (
            f"{_side}Shoulder",
            (_sign * (1.0 - INNER_SHOULDER) * _SHOULDER, 0.0, 0.0),
        ),
        f"{_side}LowerArm": (f"{_side}UpperArm", (_sign * _UPPER_ARM, 0.0, 0.0)),
        f"{_side}Hand": (f"{_side}LowerArm", (_sign * _FOREARM, 0.0, 0.0)),
    }
for _side, _sign in (("Left", -1.0), ("Right", 1.0)):
    _TREE |= {
        f"{_side}UpperLeg": ("Hips", (_sign * _HIP_X, 0.0, 0.0)),
        f"{_side}LowerLeg": (f"{_side}UpperLeg", (0.0, -_THIGH, 0.0)),
        f"{_side}Foot": (f"{_side}LowerLeg", (0.0, -_SHANK, 0.0)),
        f"{_side}Toes": (f"{_side}Foot", (0.0, -0.06, -0.13)),
    }
NAMES = ("Hips", *_TREE)


def body() -> Rig:
    """Return the bones of the synthetic person."""
    parents = (-1, *(NAMES.index(parent) for parent, _ in _TREE.values()))
    offsets = np.array(((0.0, 0.0, 0.0), *(offset for _, offset in _TREE.values())))
    return Rig(NAMES, parents, offsets, identity(len(NAMES)))


def moving(seed: int, frames: int = 200) -> RigMotion:
    """Return a movement: a third of its frames in the T-pose, then random bending of the limbs."""
    rng = np.random.default_rng(seed)
    rotations, stand = identity(frames, len(NAMES)), frames // 3
    count = frames - stand

    def turn(name: str, vectors: FloatArray) -> None:
        rotations[stand:, NAMES.index(name)] = from_rotation_vector(vectors)

    def about(axis: int, low: float, high: float) -> FloatArray:
        out = np.zeros((count, 3))
        out[:, axis] = np.radians(rng.uniform(low, high, count))
        return out

    turn("Hips", rng.normal(0.0, 0.5, (count, 3)))
    for name in ("Spine", "UpperChest", "Neck", "Head"):
        turn(name, about(0, -15.0, 15.0))
    for side, sign in (("Left", -1.0), ("Right", 1.0)):
        turn(f"{side}UpperArm", rng.normal(0.0, 0.6, (count, 3)))
        hinge, twist = about(1, 30.0, 100.0), about(0, -60.0, 60.0)
        rotations[stand:, NAMES.index(f"{side}LowerArm")] = multiply(
            from_rotation_vector(sign * hinge), from_rotation_vector(twist)
        )
        turn(f"{side}Hand", about(2, -30.0, 30.0))
        turn(f"{side}UpperLeg", rng.normal(0.0, 0.5, (count, 3)))
        turn(f"{side}LowerLeg", about(0, -80.0, -5.0))
        turn(f"{side}Foot", about(0, -20.0, 20.0))
    root = np.tile((0.0, 1.0, 0.0), (frames, 1))
    root[stand:] = rng.uniform((-2.0, 0.5, -2.0), (2.0, 0.55, 2.0), (count, 3))
    observed = np.ones((frames, len(NAMES)), np.bool_)
    return RigMotion(body(), RATE_HZ, root, normalise(rotations), observed)


@dataclass(frozen=True)
class _On:
    """A marker: the joint it moves with, and its place in that joint's axes."""

    joint: str
    place: tuple[float, float, float]


def markers_on(motion: RigMotion) -> MarkerMotion:
    """Return the movement of the CMU's markers on the person."""
    positions, world = motion.world()
    places = _marker_places()
    seen = [
        positions[:, NAMES.index(on.joint)]
        + rotate(world[:, NAMES.index(on.joint)], np.array(on.place))
        for on in places.values()
    ]
    return MarkerMotion(tuple(places), motion.rate_hz, np.stack(seen, axis=1))


def _marker_places() -> dict[str, _On]:
    _, y, z = _FRONT
    neck_to_c7 = 0.05
    out = {
        "C7": _On("UpperChest", (0.0, 0.2, neck_to_c7)),
        "CLAV": _On("UpperChest", (0.0, 0.2, -2.0 * neck_to_c7)),
        "T10": _On("UpperChest", (0.0, 0.0, 0.1)),
        "STRN": _On("UpperChest", (0.0, 0.0, -0.1)),
    }
    knee, ankle = _HALF_WIDTHS
    elbow = ELBOW_HALF_WIDTH * _FOREARM / np.sqrt(1.0 - ELBOW_HALF_WIDTH**2)
    drop = SHOULDER_DROP * 2.0 * _SHOULDER
    for letter, side, sign in (("L", "Left", -1.0), ("R", "Right", 1.0)):
        half = sign * WIDTH / 2.0
        out |= {
            f"{letter}FWT": _On("Hips", (half, y, z)),
            f"{letter}BWT": _On("Hips", (0.4 * half, y, z + DEPTH)),
            f"{letter}KNE": _On(f"{side}LowerLeg", (sign * knee, 0.0, 0.0)),
            f"{letter}ANK": _On(f"{side}LowerLeg", (sign * ankle, -_SHANK, 0.0)),
            f"{letter}HEE": _On(f"{side}Foot", (0.0, -0.06, 0.05)),
            f"{letter}TOE": _On(f"{side}Foot", (0.0, -0.06, -0.13)),
            f"{letter}FHD": _On("Head", (sign * 0.07, 0.12, -0.09)),
            f"{letter}BHD": _On("Head", (sign * 0.07, 0.12, 0.09)),
            f"{letter}SHO": _On("UpperChest", (sign * _SHOULDER, 0.2 + drop, 0.0)),
            f"{letter}ELB": _On(f"{side}UpperArm", (sign * _UPPER_ARM, elbow, 0.0)),
            f"{letter}WRA": _On(f"{side}LowerArm", (sign * _FOREARM, 0.0, -0.03)),
            f"{letter}WRB": _On(f"{side}LowerArm", (sign * _FOREARM, 0.0, 0.03)),
            f"{letter}FIN": _On(f"{side}Hand", (sign * 0.09, 0.0, 0.0)),
        }
    return out


# The fit takes half widths as shares of the distance m between the outer markers of knee and ankle,
# and m^2 = shank^2 + (knee - ankle)^2.
_APART = _SHANK / np.sqrt(1.0 - (KNEE_HALF_WIDTH - ANKLE_HALF_WIDTH) ** 2)
_HALF_WIDTHS = (KNEE_HALF_WIDTH * _APART, ANKLE_HALF_WIDTH * _APART)

BODIES = (
    "hip",
    "collar",
    "head",
    "left_shoulder",
    "left_elbow",
    "left_hand",
    "right_shoulder",
    "right_elbow",
    "right_hand",
)
_JOINT_OF = {
    "hip": "Hips",
    "collar": "Neck",
    "head": "Head",
    "left_shoulder": "LeftUpperArm",
    "left_elbow": "LeftLowerArm",
    "left_hand": "LeftHand",
    "right_shoulder": "RightUpperArm",
    "right_elbow": "RightLowerArm",
    "right_hand": "RightHand",
}


def bodies_on(motion: RigMotion, seed: int) -> BodyMotion:
    """Return rigid bodies at the joints, each attached in a random orientation."""
    rng = np.random.default_rng(seed)
    positions, world = motion.world()
    joints = [motion.rig.index(_JOINT_OF[name]) for name in BODIES]
    strapped = normalise(rng.normal(size=(len(BODIES), 4)))
    return BodyMotion(
        BODIES,
        np.arange(motion.frame_count) / motion.rate_hz,
        positions[:, joints],
        multiply(world[:, joints], strapped),
    )
