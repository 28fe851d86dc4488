"""A skeleton from markers or rigid bodies: joint centres, then axes, then bones of one length."""

import numpy as np

from app.science.fitting.assembly import assemble
from app.science.fitting.bodies import parts_of_bodies
from app.science.fitting.landmarks import landmarks_of
from app.science.fitting.lower_body import legs_of, pelvis_of
from app.science.fitting.model import FitError, Fitted, Part, Parts
from app.science.fitting.resampling import longest_run
from app.science.fitting.upper_body import arms_of, head_of, trunk_of
from app.science.rig import BodyMotion, BoolArray, MarkerMotion
from app.science.skeleton import JOINT_NAMES

_SHORTEST_S = 0.5
_WORTH_TRIMMING = 0.8
"""A limb that would cost more than a fifth of the frames is left out instead."""


def fit_skeleton(motion: MarkerMotion | BodyMotion) -> Fitted:
    """Fit the body's skeleton to markers of a known set, or to rigid bodies on the upper body.

    Gaps of up to half a second are bridged by straight lines and marked as not observed. Where a
    needed joint is missing for longer, the longest stretch without such a gap is kept. Heels, head
    bands and pelvis seldom carry their markers level: each part is tilted by a constant so that it
    stands level where the body stands tall (feet: where they move least).

    Args:
        motion: y up, metres.

    Returns:
        The movement of a rig named like the body, and what it leaves out.

    Raises:
        FitError: what is there is no body, or no stretch of half a second holds it.
    """
    if isinstance(motion, BodyMotion):
        core, limbs, rate_hz, notes = parts_of_bodies(motion)
    else:
        core, limbs, notes = _parts_of_markers(motion)
        rate_hz = motion.rate_hz
    first, end, chosen, trimmed = _choose(core, limbs, rate_hz)
    kept = {name: _cut(part, first, end) for name, part in chosen.items()}
    fitted, residual_m = assemble(kept, rate_hz)
    unfitted = tuple(name for name in JOINT_NAMES if name not in kept)
    bridged = 1.0 - float(fitted.observed.mean())
    if bridged > 0.0:
        trimmed.append(f"{100 * bridged:.2g} % of the joints' values were bridged over short gaps.")
    return Fitted(fitted, unfitted, residual_m, first, (*notes, *trimmed))


def _parts_of_markers(motion: MarkerMotion) -> tuple[Parts, dict[str, Parts], tuple[str, ...]]:
    if motion.frame_count == 0:
        raise FitError("There is no frame, so nothing to fit a skeleton to.")
    marks = landmarks_of(motion)
    pelvis, spine = pelvis_of(marks)
    core = pelvis | legs_of(marks, pelvis)
    limbs: dict[str, Parts] = {}
    trunk = trunk_of(marks, pelvis["Hips"], spine)
    if trunk:
        limbs["trunk"] = trunk
        limbs["head"] = head_of(marks, trunk)
        limbs |= {f"{side.lower()} arm": arm for side, arm in arms_of(marks, trunk).items()}
    note = f"Markers were read as the set {marks.set.title}, {len(marks.markers)} landmarks."
    return core, {name: parts for name, parts in limbs.items() if parts}, (note,)


def _choose(
    core: Parts, limbs: dict[str, Parts], rate_hz: float
) -> tuple[int, int, Parts, list[str]]:
    """The stretch to keep and the parts that hold all through it; the trunk comes before limbs."""
    good = _all_there(core)
    first, end = longest_run(good)
    if end - first < max(2, _SHORTEST_S * rate_hz):
        raise FitError(_never_whole(core, end - first, rate_hz))
    chosen, notes, trunk_there = dict(core), [], False
    for name, parts in limbs.items():
        if name != "trunk" and "trunk" in limbs and not trunk_there:
            continue
        with_it = good & _all_there(parts)
        start, stop = longest_run(with_it)
        if stop - start < _WORTH_TRIMMING * (end - first):
            notes.append(
                f"The {name} is left out: it was seen for {(stop - start) / rate_hz:.1f} s of"
                f" {(end - first) / rate_hz:.1f} s at a stretch."
            )
            continue
        trunk_there = trunk_there or name == "trunk"
        chosen |= parts
        good, first, end = with_it, start, stop
    if end - first < len(good):
        notes.append(
            f"Only {(end - first) / rate_hz:.2f} s from {first / rate_hz:.2f} s on are used, of"
            f" {len(good) / rate_hz:.2f} s: elsewhere a joint is missing for more than half a"
            " second."
        )
    return first, end, chosen, notes


def _all_there(parts: Parts) -> BoolArray:
    there: BoolArray = np.all([part.there for part in parts.values()], axis=0)
    return there


def _never_whole(core: Parts, frames: int, rate_hz: float) -> str:
    shares = {name: float(part.there.mean()) for name, part in core.items()}
    worst = min(shares, key=lambda name: shares[name])
    return (
        f"No stretch of {_SHORTEST_S} s holds pelvis and legs whole: the longest has"
        f" {frames / rate_hz:.2f} s. {worst} is missing most, it could be had in"
        f" {100 * shares[worst]:.0f} % of the frames. Fill the gaps of its markers in the capture"
        " software and export again."
    )


def _cut(part: Part, first: int, end: int) -> Part:
    axes = None if part.axes is None else part.axes[first:end]
    return Part(part.centre_m[first:end], axes, part.seen[first:end])
