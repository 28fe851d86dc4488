"""Compute the joints of pelvis and legs from their landmarks.

Hip centres: Harrington et al. (2007), J. Biomech. 40:595-602, single-variable regressions, which
are valid for both adults and children. In the plane of the front and back landmarks, from the
middle of the front ones, with pelvic depth PD and width PW in millimetres:

    back 0.24 PD + 9.9,   down 0.30 PW + 10.9,   to the side 0.33 PW + 7.3

Knee and ankle lie midway between outer and inner marker. With an outer marker only, they lie half a
joint's width inwards along the knee's axis. That axis is perpendicular to shank and foot, which are
at a right angle to each other even where hip, knee and ankle are nearly in line and define no
plane; the angle by which the foot points outwards is taken from the frames in which the knee is
well bent. The half widths, marker included, are 0.16 and 0.105 of the distance between the outer
markers of knee and ankle (6.4 cm and 4.2 cm for 40 cm), as measured between inner and outer markers
of the two people of `Gait.c3d` and `walk.trc`, BMC data set (0.160 to 0.165 and 0.099 to 0.113).
"""

import numpy as np

from app.science.fitting.frames import (
    across,
    dot,
    frame,
    highest,
    in_frame,
    levelled,
    median_distance,
    to_world,
    unit,
)
from app.science.fitting.landmarks import Landmarks
from app.science.fitting.model import FitError, Part, Parts
from app.science.rotations import FloatArray

KNEE_HALF_WIDTH, ANKLE_HALF_WIDTH = 0.16, 0.105
_WELL_BENT_RAD = np.radians(35.0)
_FEWEST_BENT = 10
_SPINE_FROM_FRONT = 0.6
"""Position of the spine's lowest joint between the pelvis' front (0) and back (1); our estimate."""
_SIDES = (("L", "Left"), ("R", "Right"))


def pelvis_of(marks: Landmarks) -> tuple[Parts, FloatArray]:
    """Return the hips, both hip joints, and the position of the spine's lowest joint (N, 3).

    Raises:
        FitError: the pelvis has fewer than three of its landmarks.
    """
    back = ("LPSI", "RPSI") if marks.has("LPSI", "RPSI") else ("SACR",)
    if not marks.has("LASI", "RASI", *back):
        raise FitError(_missing_markers("the pelvis", marks, "LASI, RASI and SACR (or LPSI, RPSI)"))
    front, rear = marks.middle("LASI", "RASI"), marks.middle(*back)
    anatomical = frame("x", marks["RASI"] - marks["LASI"], "z", rear - front)
    depth, width = median_distance(front, rear), median_distance(marks["LASI"], marks["RASI"])
    axes = levelled(anatomical, highest(front[:, 1]))
    seen = marks.all_seen("LASI", "RASI", *back)
    hips: list[FloatArray] = []
    for side in (-1.0, 1.0):
        place = np.array(
            (side * (0.33 * width + 0.0073), -(0.30 * width + 0.0109), 0.24 * depth + 0.0099)
        )
        hips.append(front + to_world(anatomical, place))
    parts = {"Hips": Part(0.5 * (hips[0] + hips[1]), axes, seen)}
    for (_, side_name), centre in zip(_SIDES, hips, strict=True):
        parts[f"{side_name}UpperLeg"] = Part(centre, None, seen)
    return parts, front + _SPINE_FROM_FRONT * (rear - front)


def legs_of(marks: Landmarks, pelvis: Parts) -> Parts:
    """Return both legs: hip joints with the thighs' rotations, knees, ankles and toes.

    Raises:
        FitError: a knee, ankle or foot has no marker.
    """
    parts: Parts = {}
    for letter, side in _SIDES:
        if not marks.has(f"{letter}KNE", f"{letter}ANK") or _toe(marks, letter) is None:
            raise FitError(
                _missing_markers(
                    f"the {side.lower()} leg", marks, f"{letter}KNE, {letter}ANK and {letter}TOE"
                )
            )
        parts |= _leg(marks, letter, side, pelvis[f"{side}UpperLeg"])
    return parts


def _leg(marks: Landmarks, letter: str, side: str, hip: Part) -> Parts:
    toe, toe_marks = _toe(marks, letter) or (marks[f"{letter}ANK"], ())
    outer = [f"{letter}KNE", f"{letter}ANK"]
    heel = f"{letter}HEE" if marks.has(f"{letter}HEE") else f"{letter}ANK"
    forward = toe - marks[heel]
    inner = [f"{letter}KNM", f"{letter}ANM"]
    if all(marks.nearly_always_with(*pair) for pair in zip(inner, outer, strict=True)):
        knee, ankle = (marks.middle(*pair) for pair in zip(outer, inner, strict=True))
        sideways = (1.0 if letter == "L" else -1.0) * (marks[inner[0]] - marks[outer[0]])
        joints = (*outer, *inner)
    else:
        knee, ankle, sideways = _joints_from_outer(marks, letter, forward, hip.centre_m)
        joints = (*outer, heel, *toe_marks)
    seen = marks.all_seen(*joints)
    foot = _foot(marks, letter, forward, sideways, ankle)
    return {
        f"{side}UpperLeg": Part(
            hip.centre_m, frame("y", hip.centre_m - knee, "x", sideways), hip.seen & seen
        ),
        f"{side}LowerLeg": Part(knee, frame("y", knee - ankle, "x", sideways), seen),
        f"{side}Foot": Part(ankle, foot, seen & marks.all_seen(heel, *toe_marks)),
        f"{side}Toes": Part(toe, None, marks.all_seen(*toe_marks)),
    }


def _joints_from_outer(
    marks: Landmarks, letter: str, forward: FloatArray, hip: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return knee, ankle and the knee's axis to the right, from outer markers and the foot."""
    knee_mark, ankle_mark = marks[f"{letter}KNE"], marks[f"{letter}ANK"]
    inwards = 1.0 if letter == "L" else -1.0
    length = median_distance(knee_mark, ankle_mark)
    half_knee, half_ankle = inwards * KNEE_HALF_WIDTH * length, inwards * ANKLE_HALF_WIDTH * length
    # The shank from ankle to knee is (knee mark - ankle mark) + (half_knee - half_ankle) axis, and
    # the axis is perpendicular to it.
    shank = knee_mark - ankle_mark
    axis = across(forward, 0.0, shank, half_ankle - half_knee)
    axis = _turned_to_bend(axis, hip, knee_mark, ankle_mark, (half_knee, half_ankle))
    return knee_mark + half_knee * axis, ankle_mark + half_ankle * axis, axis


def _turned_to_bend(
    axis: FloatArray,
    hip: FloatArray,
    knee_mark: FloatArray,
    ankle_mark: FloatArray,
    half_widths: tuple[float, float],
) -> FloatArray:
    """Turn the foot's axis about the shank by a constant, so that the knee bends about it."""
    half_knee, half_ankle = half_widths
    thigh, shank = hip - knee_mark, knee_mark - ankle_mark
    bent = across(shank, half_ankle - half_knee, thigh, half_knee)
    # A knee bends backwards only: drop normals of thigh and shank that point to the other side.
    bent = np.where((dot(bent, axis) < 0.0)[:, None], np.nan, bent)
    angle = np.arccos(np.clip(dot(unit(thigh), unit(shank)), -1.0, 1.0))
    local = frame("y", shank, "x", axis)
    x, _, z = in_frame(local, bent).T
    usable = np.isfinite(x) & (angle > _WELL_BENT_RAD)
    if usable.sum() < _FEWEST_BENT:
        return axis
    turn = float(np.median(np.arctan2(-z[usable], x[usable])))
    turned = to_world(local, np.array((np.cos(turn), 0.0, -np.sin(turn))))
    # Keep the axis's small component along the shank that the two half widths require.
    along = dot(axis, unit(shank))[:, None] * unit(shank)
    return unit(turned * np.sqrt(np.clip(1.0 - dot(along, along), 0.0, 1.0))[:, None] + along)


def _foot(
    marks: Landmarks, letter: str, forward: FloatArray, sideways: FloatArray, ankle: FloatArray
) -> FloatArray:
    """Return the foot's axes, level in the fifth of the frames in which it moves least."""
    across_foot = sideways
    if marks.has(f"{letter}MT1", f"{letter}MT5"):
        sign = 1.0 if letter == "L" else -1.0
        across_foot = sign * (marks[f"{letter}MT1"] - marks[f"{letter}MT5"])
    speed = np.linalg.norm(np.gradient(ankle, axis=0), axis=-1) if len(ankle) > 1 else ankle[:, 0]
    return levelled(frame("z", -forward, "x", across_foot), highest(-speed))


def _toe(marks: Landmarks, letter: str) -> tuple[FloatArray, tuple[str, ...]] | None:
    if marks.has(f"{letter}TOE"):
        return marks[f"{letter}TOE"], (f"{letter}TOE",)
    pair = (f"{letter}MT1", f"{letter}MT5")
    return (marks.middle(*pair), pair) if marks.has(*pair) else None


def _missing_markers(part: str, marks: Landmarks, needed: str) -> str:
    labels = ", ".join(marks.names[:8]) + (", ..." if len(marks.names) > 8 else "")
    recognised = ", ".join(marks.markers.values()) or "none"
    never = [name for landmark, name in marks.markers.items() if not marks.has(landmark)]
    unseen = f" {', '.join(never)} are labelled but were never seen." if never else ""
    return (
        f"No skeleton can be fitted to these {len(marks.names)} markers ({labels}): {part} needs"
        f" {needed}, labelled as in a known marker set (the closest is {marks.set.title})."
        f" Recognised: {recognised}.{unseen}"
    )
