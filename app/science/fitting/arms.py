"""Compute the joints of an arm from shoulder, elbow and wrist.

In the T-pose the palms face down and the elbow bends forwards, about the vertical. The upper arm's
y axis is therefore the elbow's axis. Where the arm is bent, this is the normal of the arm's plane.
Where the arm is straight and has no plane, it is the chest's vertical, rotated by the shortest
swing that takes the arm from the T-pose to its direction. Between 6 and 20 degrees of bend the two
are blended.
"""

import numpy as np

from app.science.fitting.frames import across, dot, frame, unit
from app.science.rotations import FloatArray

_STRAIGHT, _BENT = np.sin(np.radians(6.0)), np.sin(np.radians(20.0))
Limb = dict[str, tuple[FloatArray, FloatArray | None]]


def arm(
    side: str,
    chest_axes: FloatArray,
    shoulder: FloatArray,
    outer_elbow: FloatArray,
    wrist: FloatArray,
    *,
    half_width_m: float = 0.0,
    inner: FloatArray | None = None,
    across_wrist: FloatArray | None = None,
    fingers: FloatArray | None = None,
) -> Limb:
    """Return centres (N, 3) and axes (N, 3, 3) of upper arm, forearm and hand.

    Args:
        side: the arm, "Left" or "Right".
        chest_axes: (N, 3, 3) axes of the chest.
        shoulder, wrist: (N, 3) centres.
        outer_elbow: (N, 3) marker on the outer side, or the centre with a half width of 0.
        half_width_m: distance from that marker to the centre.
        inner: marker on the inner side of the elbow, if any.
        across_wrist: direction from the thumb's side to the little finger's, if marked.
        fingers: position of the knuckles, if marked.
    """
    sign = 1.0 if side == "Right" else -1.0
    if inner is not None:
        elbow, axis = 0.5 * (outer_elbow + inner), outer_elbow - inner
    else:
        axis = _bend_axis(sign, chest_axes, shoulder, outer_elbow, wrist, half_width_m)
        elbow = outer_elbow - half_width_m * axis
    upper = frame("x", sign * (elbow - shoulder), "y", axis)
    along = sign * (wrist - elbow)
    lower = frame("x", along, "y", axis)
    if across_wrist is not None:
        lower = frame("x", along, "z", across_wrist)
    hand = None
    if fingers is not None:
        hand = frame("x", sign * (fingers - wrist), "z", lower[..., 2])
    return {"UpperArm": (shoulder, upper), "LowerArm": (elbow, lower), "Hand": (wrist, hand)}


def _bend_axis(
    sign: float,
    chest_axes: FloatArray,
    shoulder: FloatArray,
    outer: FloatArray,
    wrist: FloatArray,
    half: float,
) -> FloatArray:
    """Return the elbow's axis, pointing to its outer side, which is up in the T-pose."""
    upper, lower = outer - shoulder, wrist - outer
    # With the centre e = outer - half n: n is perpendicular to e - shoulder and to wrist - e.
    outwards = (upper, half, lower, -half) if sign > 0.0 else (lower, -half, upper, half)
    bent = across(*outwards)
    # The outer marker is off the arm's line even if the arm is straight: use the centres for the
    # bend.
    above, below = upper - half * bent, lower + half * bent
    sine = np.linalg.norm(np.cross(unit(above), unit(below)), axis=-1)
    weight = np.clip((sine - _STRAIGHT) / (_BENT - _STRAIGHT), 0.0, 1.0)
    weight = np.where(np.isfinite(bent).all(axis=-1), weight, 0.0)[:, None]
    # Lean the axis towards the shoulder by as much as the outer marker tilts the line to it.
    lean = (half / np.linalg.norm(upper, axis=-1))[:, None]
    rest = np.sqrt(np.clip(1.0 - lean**2, 0.0, 1.0))
    straight = rest * _swung_up(sign, chest_axes, upper) + lean * unit(upper)
    return unit(weight * np.where(np.isfinite(bent), bent, 0.0) + (1.0 - weight) * straight)


def _swung_up(sign: float, chest_axes: FloatArray, upper: FloatArray) -> FloatArray:
    """Return the chest's y axis after the shortest swing of the arm from sideways to `upper`."""
    start, end = sign * chest_axes[..., 0], unit(upper)
    vertical = chest_axes[..., 1]
    # Rodrigues' formula for the swing from `start` to `end`: v - (v.(s+e)) (s+e) / (1+s.e)
    # + 2 (v.s) e, where v is perpendicular to s.
    both = start + end
    denominator = np.maximum(1.0 + dot(start, end), 1e-6)[:, None]
    return unit(vertical - dot(vertical, both)[:, None] * both / denominator)
