"""Compute the joints of trunk, head and arms from their landmarks, as far as they are marked.

Neck: a third of the way from C7 to the top of the breast bone; upper chest: midway between T10 and
the bottom of the breast bone, or 0.55 of the way from the spine's lowest joint to the neck; the
head's joint: 0.4 of the way from neck to the middle of the head band. These are our own estimates.
Shoulder: below the marker on top of it by 0.17 of the distance between the two, along the trunk
(Rab, Petuskey and Bagley 2002, Gait & Posture 15:113-119).
Elbow: midway between outer and inner marker; with an outer one only, half a width (0.16 of the
distance from that marker to the wrist, our estimate) inwards along the axis about which it bends.
"""

import numpy as np

from app.science.fitting.arms import arm
from app.science.fitting.frames import frame, highest, in_frame, levelled, median_distance, to_world
from app.science.fitting.landmarks import Landmarks
from app.science.fitting.model import Part, Parts
from app.science.rotations import FloatArray

ELBOW_HALF_WIDTH = 0.16
SHOULDER_DROP = 0.17
_NECK_FROM_C7, _CHEST_ON_TRUNK, _HEAD_ON_BAND = 1.0 / 3.0, 0.55, 0.4
INNER_SHOULDER = 0.15
"""Inner end of the collar bone on the way from neck to shoulder; our estimate."""


def trunk_of(marks: Landmarks, hips: Part, spine: FloatArray) -> Parts:
    """Return spine, upper chest and neck; empty if C7 or the breast bone is not marked."""
    if not marks.has("C7", "CLAV") or hips.axes is None:
        return {}
    neck = marks["C7"] + _NECK_FROM_C7 * (marks["CLAV"] - marks["C7"])
    seen = marks.all_seen("C7", "CLAV")
    if marks.has("T10", "STRN"):
        chest = marks.middle("T10", "STRN")
        up = marks.middle("C7", "CLAV") - chest
        seen = seen & marks.all_seen("T10", "STRN")
        forward = marks.middle("CLAV", "STRN") - marks.middle("C7", "T10")
        axes = frame("y", up, "z", -forward)
    else:
        chest, up = spine + _CHEST_ON_TRUNK * (neck - spine), neck - spine
        axes = frame("y", up, "z", marks["C7"] - marks["CLAV"])
    axes = levelled(axes, highest(neck[:, 1]))
    middle = hips.axes[..., 0] + axes[..., 0]
    return {
        "Spine": Part(spine, frame("y", chest - spine, "x", middle), hips.seen & seen),
        "UpperChest": Part(chest, axes, seen),
        "Neck": Part(neck, None, marks.all_seen("C7", "CLAV")),
    }


def head_of(marks: Landmarks, trunk: Parts) -> Parts:
    """Return neck and head; empty if the head band lacks one of its four markers."""
    names = ("LFHD", "RFHD", "LBHD", "RBHD")
    if not marks.has(*names) or not trunk:
        return {}
    right = marks.middle("RFHD", "RBHD") - marks.middle("LFHD", "LBHD")
    back = marks.middle("LBHD", "RBHD") - marks.middle("LFHD", "RFHD")
    band = marks.middle(*names)
    upright = highest(band[:, 1])
    axes = levelled(frame("x", right, "z", back), upright)
    neck, seen = trunk["Neck"], marks.all_seen(*names)
    # Nodding brings band and neck together, so their distance is measured while the head is up.
    tall = median_distance(band[upright], neck.centre_m[upright])
    below = (1.0 - _HEAD_ON_BAND) * tall
    head = band - below * axes[..., 1]
    return neck_and_head(trunk, Part(head, axes, seen))


def neck_and_head(trunk: Parts, head: Part) -> Parts:
    """Return the head, and the neck pointing to it and turned half-way between trunk and head."""
    neck, chest = trunk["Neck"], trunk.get("UpperChest", trunk["Spine"])
    if chest.axes is None or head.axes is None:
        return {}
    middle = chest.axes[..., 0] + head.axes[..., 0]
    axes = frame("y", head.centre_m - neck.centre_m, "x", middle)
    return {"Neck": Part(neck.centre_m, axes, neck.seen & head.seen), "Head": head}


def arms_of(marks: Landmarks, trunk: Parts) -> dict[str, Parts]:
    """Return by side the collar bone, upper arm, forearm and hand, if all of them are marked."""
    chest = trunk.get("UpperChest")
    if chest is None or chest.axes is None or not marks.has("LACR", "RACR"):
        return {}
    drop = SHOULDER_DROP * median_distance(marks["LACR"], marks["RACR"])
    arms: dict[str, Parts] = {}
    for letter, side in (("L", "Left"), ("R", "Right")):
        wrist = _wrist(marks, letter)
        if wrist is None or not marks.has(f"{letter}ELB"):
            continue
        shoulder = marks[f"{letter}ACR"] - drop * chest.axes[..., 1]
        collar = collar_bone(trunk["Neck"], chest.axes, shoulder, side)
        names = (f"{letter}ELB", *wrist[1])
        outer = marks[f"{letter}ELB"]
        inner = (
            marks[f"{letter}ELM"] if marks.nearly_always_with(f"{letter}ELM", names[0]) else None
        )
        half = 0.0 if inner is not None else ELBOW_HALF_WIDTH * median_distance(outer, wrist[0])
        seen = marks.all_seen(*names)
        hand = marks[f"{letter}FIN"] if marks.has(f"{letter}FIN") else None
        limb = arm(
            side, chest.axes, shoulder, outer, wrist[0],
            half_width_m=half, inner=inner, across_wrist=wrist[2], fingers=hand,
        )  # fmt: skip
        seen_above = marks.all_seen(f"{letter}ACR") & chest.seen
        arms[side] = {
            f"{side}Shoulder": Part(*collar, seen_above),
            f"{side}UpperArm": Part(*limb["UpperArm"], seen_above & seen),
            f"{side}LowerArm": Part(*limb["LowerArm"], seen),
            f"{side}Hand": Part(*limb["Hand"], seen & marks.all_seen(f"{letter}FIN")),
        }
    return arms


def collar_bone(
    neck: Part, chest_axes: FloatArray, shoulder: FloatArray, side: str
) -> tuple[FloatArray, FloatArray]:
    """Return the collar bone's inner end, fixed to the chest, and its axes towards the shoulder."""
    local = in_frame(chest_axes, shoulder - neck.centre_m)
    finite = local[np.isfinite(local).all(axis=-1)]
    if len(finite) == 0:
        return np.full_like(shoulder, np.nan), np.full((*shoulder.shape, 3), np.nan)
    inner = neck.centre_m + to_world(chest_axes, INNER_SHOULDER * np.median(finite, axis=0))
    outwards = shoulder - inner if side == "Right" else inner - shoulder
    return inner, frame("x", outwards, "y", chest_axes[..., 1])


def _wrist(
    marks: Landmarks, letter: str
) -> tuple[FloatArray, tuple[str, ...], FloatArray | None] | None:
    """Return the wrist's middle, its landmarks, and the direction from thumb to little finger."""
    pair = (f"{letter}WRA", f"{letter}WRB")
    if marks.has(*pair):
        return marks.middle(*pair), pair, marks[pair[1]] - marks[pair[0]]
    single = f"{letter}WRI"
    return (marks[single], (single,), None) if marks.has(single) else None
