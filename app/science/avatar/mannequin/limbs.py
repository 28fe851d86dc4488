"""Sew arms, legs and feet: rings around the bones, each with its own extent in four directions."""

import numpy as np
import numpy.typing as npt

from app.science.avatar.body import Proportions
from app.science.avatar.mannequin.patchwork import IndexArray, Patchwork
from app.science.avatar.mannequin.tables import Form
from app.science.rotations import FloatArray

_ARM_STEPS = (0.045, 0.14, 0.24, 0.35, 0.47, 0.60, 0.73, 0.83, 0.90, 0.955, 1.0, 1.045, 1.10,
              1.18, 1.29, 1.42, 1.55, 1.68, 1.79, 1.87, 1.895, 1.905, 1.945)  # fmt: skip
_LEG_STEPS = (0.24, 0.31, 0.40, 0.50, 0.60, 0.70, 0.79, 0.87, 0.93, 0.975, 1.015, 1.06, 1.11,
              1.17, 1.25, 1.34, 1.45, 1.56, 1.67, 1.76, 1.835, 1.847, 1.885)  # fmt: skip
_CLOTH = 0.0016
"""Thickness of sleeves and trouser legs, as a fraction of the stature."""
_FOOT_RING, _HEEL_ROWS, _ANKLE_ROWS = 16, 2, 6
_SLEEVE_ENDS, _TROUSERS_END = 1.90, 1.84


def sew_arm(work: Patchwork, body: Proportions, form: Form, hole: IndexArray) -> list[IndexArray]:
    """Sew the right arm to the wrist; return its rings, the hole's edge first.

    Rings begin at the lower front and run along the underside to the back.
    """
    work.region, work.tone = "arm", "shirt"
    places = body.places_m()
    joints = np.array([places[f"Right{part}"] for part in ("UpperArm", "LowerArm", "Hand")])
    turns = np.radians(-60.0 + 360.0 / len(hole) * np.arange(len(hole)))
    sine, cosine = np.sin(turns), np.cos(turns)
    table = _resampled(form.arm, _ARM_STEPS)
    rings = [hole]
    table += _cloth_m(body, np.array(_ARM_STEPS) <= _SLEEVE_ENDS)
    for step, (up, down, front, back) in zip(_ARM_STEPS, table, strict=True):
        centre = _along(joints, step)
        y = -cosine * np.where(cosine > 0.0, down, up)
        z = np.where(sine > 0.0, back, front) * sine
        ring = centre + np.stack((np.zeros_like(y), y, z), axis=1)
        # The first rings lean towards the trunk: the armpit lies farther out than the shoulder.
        ring[:, 0] += np.clip(0.3 - step, 0.0, 0.3) * 0.32 * (ring[:, 1] - centre[1]) * -1.0
        rings.append(work.add(ring))
        work.tone = "shirt" if step <= _SLEEVE_ENDS else "skin"
        work.strip(rings[-2], rings[-1], closed=True)
    return rings


def sew_leg(
    work: Patchwork, body: Proportions, form: Form, grid: IndexArray, crotch: IndexArray
) -> list[IndexArray]:
    """Sew the right leg and foot; return the leg's rings from the trunk down.

    Rings begin at the inner front and run over the front to the outside.
    """
    work.region, work.tone = "leg", "trousers"
    places = body.places_m()
    joints = np.array([places[f"Right{part}"] for part in ("UpperLeg", "LowerLeg", "Foot")])
    start = np.concatenate((grid[0], crotch))
    turns = np.radians(-54.0 + 360.0 / len(start) * np.arange(len(start)))
    sine, cosine = np.sin(turns), np.cos(turns)
    table = _resampled(form.leg, _LEG_STEPS)
    rings = [start]
    table += _cloth_m(body, np.array(_LEG_STEPS) <= _TROUSERS_END)
    for step, (inner, outer, front, back) in zip(_LEG_STEPS, table, strict=True):
        x = np.where(sine > 0.0, outer, inner) * sine
        z = np.where(cosine > 0.0, -front * cosine, -back * cosine)
        ring = _along(joints, step) + np.stack((x, np.zeros_like(x), z), axis=1)
        if step < 0.5:  # the first rings rise towards the outside, as the trunk's last one does
            lift = (0.5 - step) / 0.26 * np.clip(sine, -0.4, 1.0)
            ring[:, 1] += lift * 0.018 * body.stature_m
        rings.append(work.add(ring))
        work.tone = "trousers" if step <= _TROUSERS_END else "skin"
        work.strip(rings[-1], rings[-2], closed=True)
    _sew_foot(work, body, form, rings[-1])
    return rings


def _sew_foot(work: Patchwork, body: Proportions, form: Form, ankle: IndexArray) -> None:
    work.region, work.tone = "foot", "skin"
    foot = body.places_m()["RightFoot"]
    length = body.segments_m["foot"]
    heel = body.heel_m
    turns = np.radians(360.0 / _FOOT_RING * np.arange(_FOOT_RING))
    sine, cosine = np.sin(turns), np.cos(turns)
    loops = []
    for along, inner, outer, height in form.foot:
        x = np.where(sine > 0.0, outer, inner) * np.sign(sine) * np.abs(sine) ** 0.8
        # The sole is flat, the top round; both are highest over the inner edge.
        upper = np.clip(cosine, 0.0, 1.0) ** 1.0
        middle = 0.42 * height
        y = np.where(
            cosine > 0.0,
            middle + (height - middle) * upper,
            middle * (1.0 - np.abs(cosine) ** 0.45),
        )
        z = heel - along * length + 0.004 * body.stature_m * sine * (along - 0.5)
        ring = np.stack((foot[0] + x, y, np.broadcast_to(z, x.shape)), axis=1)
        loops.append(work.add(ring))
    low, high = _HEEL_ROWS, _HEEL_ROWS + _ANKLE_ROWS
    open_edges = [_FOOT_RING - 2, _FOOT_RING - 1, 0, 1]
    for row in range(len(loops) - 1):
        hole = open_edges if low <= row < high else ()
        work.strip(loops[row + 1], loops[row], closed=True, skip=hole)
    ends = (
        (loops[0], (foot[0], 0.012 * body.stature_m, heel)),
        (
            loops[-1][::-1],
            (foot[0] + 0.003 * body.stature_m, 0.005 * body.stature_m, heel - length),
        ),
    )
    for loop, tip in ends:
        work.close(loop, int(work.add(np.array([tip]))[0]), closed=True)
    around = np.concatenate(
        (
            [loops[high][number] for number in (-2, -1, 0, 1)],
            [loops[row][2] for row in range(high, low, -1)],
            [loops[low][number] for number in (2, 1, 0, -1)],
            [loops[row][-2] for row in range(low, high)],
        )
    )
    # The ankle's ring begins one point before the front inner corner.
    work.strip(around, np.roll(ankle, -1), closed=True)


def _along(joints: FloatArray, step: float) -> FloatArray:
    """Return the point of a limb: 0 to 1 on its first bone, 1 to 2 on the second."""
    bone = int(min(max(step, 0.0), 1.999))
    point: FloatArray = joints[bone] + (step - bone) * (joints[bone + 1] - joints[bone])
    return point


def _cloth_m(body: Proportions, covered: npt.NDArray[np.bool_]) -> FloatArray:
    return np.where(covered, _CLOTH * body.stature_m, 0.0)[:, np.newaxis]


def _resampled(table: FloatArray, steps: tuple[float, ...]) -> FloatArray:
    from scipy.interpolate import PchipInterpolator

    found: FloatArray = PchipInterpolator(table[:, 0], table[:, 1:], axis=0)(np.array(steps))
    return found
