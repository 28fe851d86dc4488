"""Compute joints from rigid bodies on hip, collar, head, shoulders, elbows and hands.

Vicon Tracker and OptiTrack report a position and a rotation of each body; the rotation is zero in
the orientation in which the body was defined. The positions are used as those of the joints. Of the
rotations only the change is used: how a body is oriented on its body part is a constant. For hip
and head it is found by assuming that the person stands upright and straight in the tenth of the
frames in which the collar is highest; for a hand, by assuming that on average it is aligned with
the forearm.
"""

import numpy as np

from app.science.fitting.arms import arm
from app.science.fitting.frames import UP, frame, highest, levelled
from app.science.fitting.marker_sets import normalised_label
from app.science.fitting.model import FitError, Part, Parts
from app.science.fitting.resampling import Body, bodies_at_constant_rate
from app.science.fitting.upper_body import collar_bone, neck_and_head
from app.science.rig import BodyMotion, BoolArray
from app.science.rotations import FloatArray, geodesic_angle

_UPRIGHT_SHARE = 0.1
_MOST_TURN_RAD = np.pi / 2.0
_ROLES: dict[str, tuple[str, ...]] = {
    "hip": ("HIP", "HIPS", "PELVIS", "WAIST"),
    "collar": ("COLLAR", "NECK", "STERNUM", "CHEST"),
    "head": ("HEAD", "HMD"),
    **{
        f"{side} {joint}": tuple(f"{prefix}{label}" for prefix in prefixes for label in labels)
        for side, prefixes in (("left", ("LEFT", "L")), ("right", ("RIGHT", "R")))
        for joint, labels in (
            ("shoulder", ("SHOULDER", "UPPERARM")),
            ("elbow", ("ELBOW", "FOREARM")),
            ("hand", ("HAND", "WRIST")),
        )
    },
}
_NEEDED = tuple(role for role in _ROLES if role != "head")


def parts_of_bodies(
    motion: BodyMotion,
) -> tuple[Parts, dict[str, Parts], float, tuple[str, ...]]:
    """Return the joints of core and limbs for `fit_skeleton`, the rate in Hz, and notes.

    Raises:
        FitError: bodies are missing, for example because only a headset and two controllers are
            tracked.
    """
    roles = _roles(motion.names)
    missing = [role for role in _NEEDED if role not in roles]
    if missing:
        raise FitError(_too_few(motion.names, roles, missing))
    rate_hz, bodies = bodies_at_constant_rate(motion, {r: roles[r] for r in roles})
    hip, collar = bodies["hip"], bodies["collar"]
    sideways = bodies["right shoulder"].places - bodies["left shoulder"].places
    up = collar.places - hip.places
    shoulders_seen = bodies["left shoulder"].seen & bodies["right shoulder"].seen
    seen = hip.seen & collar.seen & shoulders_seen
    upright = highest(collar.places[:, 1], _UPRIGHT_SHARE)
    straight = frame("y", np.broadcast_to(UP, up.shape), "x", sideways)
    trunk = levelled(frame("y", up, "x", sideways), upright)
    parts: Parts = {
        "Hips": Part(hip.places, _aligned(hip.axes, straight, upright), hip.seen),
        "Spine": Part(hip.places, trunk, seen),
        "Neck": Part(collar.places, None, collar.seen),
    }
    limbs: dict[str, Parts] = {}
    if "head" in bodies:
        head = bodies["head"]
        axes = _aligned(head.axes, straight, upright)
        limbs["head"] = neck_and_head(parts, Part(head.places, axes, head.seen))
    for side in ("Left", "Right"):
        limbs[f"{side.lower()} arm"] = _arm(side, bodies, parts["Neck"], trunk, seen)
    used = ", ".join(roles.values())
    notes = (f"The bodies {used} were used as joints.", *_flips(motion, roles))
    return parts, limbs, rate_hz, notes


def _flips(motion: BodyMotion, roles: dict[str, str]) -> list[str]:
    """Return a note on each body that turns by more than a quarter turn between samples.

    Such a turn is a mistake of the tracking system.
    """
    notes = []
    for name in roles.values():
        rotations = motion.rotations[:, motion.names.index(name)]
        turns = geodesic_angle(rotations[1:], rotations[:-1])
        count = int((turns > _MOST_TURN_RAD).sum())
        if count:
            notes.append(
                f"{name} turns by more than 90 degrees from one sample to the next {count} times:"
                " the tracking system confused its markers."
            )
    return notes


def _arm(
    side: str, bodies: dict[str, Body], neck: Part, trunk: FloatArray, trunk_seen: BoolArray
) -> Parts:
    shoulder, elbow, hand = (bodies[f"{side.lower()} {j}"] for j in ("shoulder", "elbow", "hand"))
    limb = arm(side, trunk, shoulder.places, elbow.places, hand.places)
    collar = collar_bone(neck, trunk, shoulder.places, side)
    forearm = limb["LowerArm"][1]
    always: BoolArray = np.ones(len(trunk), np.bool_)
    palm = hand.axes if forearm is None else _aligned(hand.axes, forearm, always)
    reach = shoulder.seen & elbow.seen
    return {
        f"{side}Shoulder": Part(*collar, trunk_seen & shoulder.seen),
        f"{side}UpperArm": Part(*limb["UpperArm"], reach),
        f"{side}LowerArm": Part(*limb["LowerArm"], elbow.seen & hand.seen),
        f"{side}Hand": Part(hand.places, palm, hand.seen),
    }


def _aligned(body: FloatArray, part: FloatArray, frames: BoolArray) -> FloatArray:
    """Return the axes of a body part in all frames, from those of the rigid body attached to it.

    `part` gives the part's axes in the `frames` in which they are known. The constant
    body_from_part is the rotation nearest to the mean of the matrices.
    """
    usable = frames & np.isfinite(body).all(axis=(-1, -2)) & np.isfinite(part).all(axis=(-1, -2))
    if not usable.any():
        return np.full_like(body, np.nan)
    mean = np.mean(np.swapaxes(body[usable], -1, -2) @ part[usable], axis=0)
    u, _, v = np.linalg.svd(mean)
    turn = u @ np.diag((1.0, 1.0, np.sign(np.linalg.det(u @ v)) or 1.0)) @ v
    aligned: FloatArray = body @ turn
    return aligned


def _roles(names: tuple[str, ...]) -> dict[str, str]:
    by_label = {normalised_label(name): name for name in reversed(names)}
    found = {
        role: next((by_label[label] for label in labels if label in by_label), None)
        for role, labels in _ROLES.items()
    }
    return {role: name for role, name in found.items() if name is not None}


def _too_few(names: tuple[str, ...], roles: dict[str, str], missing: list[str]) -> str:
    listed = ", ".join(names[:12]) or "none"
    if len(names) <= 3:
        return (
            f"Too few tracked bodies for a skeleton ({listed}): the positions of"
            " elbows, trunk and legs are unknown. Needed are bodies on hip, collar and both"
            " shoulders, elbows and hands, a marker set of the whole body, or a suit's skeleton."
        )
    recognised = ", ".join(roles) or "none"
    return (
        f"No skeleton can be fitted to the bodies ({listed}): {', '.join(missing)} missing."
        f" Recognised: {recognised}."
        " Needed are bodies on hip, collar and both shoulders, elbows and hands, with these names."
    )
