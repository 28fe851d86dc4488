"""Fit a skeleton to markers or rigid bodies: joint centres, then axes, then bone lengths."""

from dataclasses import replace

import numpy as np

from app.science.anatomy import (
    Notice,
    frozen_notice,
    handedness_of,
    mirrored_bodies,
    mirrored_markers,
    mirrored_notice,
    repeated,
    sentences,
    tilts_deg,
    turned_over_bodies,
    turned_over_markers,
    upright_notice,
)
from app.science.fitting.assembly import assemble
from app.science.fitting.bodies import parts_of_bodies
from app.science.fitting.constrained import constrained
from app.science.fitting.label_checks import exchanged_notice, label_notice, unlike_a_body
from app.science.fitting.landmarks import Landmarks, landmarks_of
from app.science.fitting.lower_body import legs_of, pelvis_of
from app.science.fitting.model import FitError, Fitted, Part, Parts
from app.science.fitting.resampling import longest_run
from app.science.fitting.upper_body import arms_of, head_of, trunk_of
from app.science.rig import BodyMotion, BoolArray, MarkerMotion, RigMotion
from app.science.rotations import FloatArray
from app.science.skeleton import JOINT_NAMES

_SHORTEST_S = 0.5
_WORTH_TRIMMING = 0.8
"""A limb is left out if keeping it would cost more than a fifth of the frames."""


def fit_skeleton(motion: MarkerMotion | BodyMotion) -> Fitted:
    """Fit the body's skeleton to markers of a known set, or to rigid bodies on the upper body.

    Gaps of up to half a second are bridged by linear interpolation and marked as not observed.
    Where a required joint is missing for longer, the longest stretch without such a gap is kept.
    Markers on heels, head bands and pelvis are seldom level: each part is tilted by a constant so
    that it is level when the body stands tall (feet: when they move least).

    Args:
        motion: the captured markers or bodies, y up, in metres.

    Returns:
        The movement of a rig whose joints are named like the body's, and what it leaves out.

    Raises:
        FitError: the data do not contain a body, or not for half a second without a gap, or what
            they contain is no person's.
    """
    notices: list[Notice] = []
    if isinstance(motion, BodyMotion):
        fit = _fit_bodies(motion)
        upright = upright_notice(tilts_deg(_places(fit.motion)))
        if upright is not None:
            notices.append(upright)
        if upright is not None and upright.action == "mended":
            motion = turned_over_bodies(motion)
            fit = _fit_bodies(motion)
        found = handedness_of(_places(fit.motion))
        if found.is_mirrored:
            share = 100.0 * max(found.agreeing.values())
            value = f"{share:.0f} % of the elbows bend as those of people"
            notices.append(mirrored_notice(value, "more than 20 %"))
            fit = _fit_bodies(mirrored_bodies(motion))
    else:
        fit, notices = _fit_markers(motion)
    lengths, changed = constrained(fit.motion)
    frozen = _frozen(motion)
    told = (*notices, *changed, *(() if frozen is None else (frozen,)))
    return replace(fit, motion=lengths, notes=(*fit.notes, *sentences(told)), notices=told)


def _frozen(motion: MarkerMotion | BodyMotion) -> Notice | None:
    what = "everything that is tracked"
    return frozen_notice({what: repeated(motion.positions_m)}, motion.rate_hz)


def _fit_bodies(motion: BodyMotion) -> Fitted:
    core, limbs, rate_hz, notes = parts_of_bodies(motion)
    return _assembled(core, limbs, rate_hz, notes)


def _fit_markers(motion: MarkerMotion) -> tuple[Fitted, list[Notice]]:
    if motion.frame_count == 0:
        raise FitError("The capture has no frames, so no skeleton can be fitted.")
    notices: list[Notice] = []
    marks = landmarks_of(motion)
    noise = unlike_a_body(marks)
    if noise is not None:
        raise FitError(noise.sentence)
    exchanged = exchanged_notice(marks)
    if exchanged is not None:
        notices.append(exchanged)
    upright = upright_notice(tilts_deg(_joints_near(marks)))
    if upright is not None:
        notices.append(upright)
    if upright is not None and upright.action == "mended":
        motion = turned_over_markers(motion)
        marks = landmarks_of(motion)
    wrong = label_notice(marks)
    if wrong is not None and wrong.action == "refused":
        raise FitError(wrong.sentence)
    if wrong is not None:
        notices.append(wrong)
        marks = landmarks_of(mirrored_markers(motion))
    core, limbs, notes = _parts_of_markers(marks)
    return _assembled(core, limbs, motion.rate_hz, notes), notices


def _joints_near(marks: Landmarks) -> dict[str, FloatArray]:
    """Return markers that are near enough to hips and ankles to tell up from down."""
    if not marks.has("LASI", "RASI", "LANK", "RANK"):
        return {}
    hips = marks.middle("LASI", "RASI")
    return {"Hips": hips, "LeftFoot": marks["LANK"], "RightFoot": marks["RANK"]}


def _places(motion: RigMotion) -> dict[str, FloatArray]:
    positions, _ = motion.world()
    return {name: positions[:, joint] for joint, name in enumerate(motion.rig.names)}


def _assembled(
    core: Parts, limbs: dict[str, Parts], rate_hz: float, notes: tuple[str, ...]
) -> Fitted:
    first, end, chosen, trimmed = _choose(core, limbs, rate_hz)
    kept = {name: _cut(part, first, end) for name, part in chosen.items()}
    fitted, residual_m = assemble(kept, rate_hz)
    unfitted = tuple(name for name in JOINT_NAMES if name not in kept)
    bridged = 1.0 - float(fitted.observed.mean())
    if bridged > 0.0:
        trimmed.append(f"{100 * bridged:.2g} % of the joints' values were bridged over short gaps.")
    return Fitted(fitted, unfitted, residual_m, first, (*notes, *trimmed))


def _parts_of_markers(marks: Landmarks) -> tuple[Parts, dict[str, Parts], tuple[str, ...]]:
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
    """Return the stretch to keep (first frame, end), the parts that are valid in it, and notes.

    Limbs are only considered once the trunk is accepted.
    """
    usable = _all_present(core)
    first, end = longest_run(usable)
    if end - first < max(2, _SHORTEST_S * rate_hz):
        raise FitError(_incomplete(core, end - first, rate_hz))
    chosen, notes, trunk_present = dict(core), [], False
    for name, parts in limbs.items():
        if name != "trunk" and "trunk" in limbs and not trunk_present:
            continue
        with_it = usable & _all_present(parts)
        start, stop = longest_run(with_it)
        if stop - start < _WORTH_TRIMMING * (end - first):
            notes.append(
                f"The {name} is left out: it was seen without a gap for only"
                f" {(stop - start) / rate_hz:.1f} s of {(end - first) / rate_hz:.1f} s."
            )
            continue
        trunk_present = trunk_present or name == "trunk"
        chosen |= parts
        usable, first, end = with_it, start, stop
    if end - first < len(usable):
        notes.append(
            f"Only {(end - first) / rate_hz:.2f} s from {first / rate_hz:.2f} s on are used, of"
            f" {len(usable) / rate_hz:.2f} s: elsewhere a joint is missing for more than half a"
            " second."
        )
    return first, end, chosen, notes


def _all_present(parts: Parts) -> BoolArray:
    present: BoolArray = np.all([part.present for part in parts.values()], axis=0)
    return present


def _incomplete(core: Parts, frames: int, rate_hz: float) -> str:
    shares = {name: float(part.present.mean()) for name, part in core.items()}
    worst = min(shares, key=lambda name: shares[name])
    return (
        f"Pelvis and legs are never complete for {_SHORTEST_S} s: the longest stretch lasts"
        f" {frames / rate_hz:.2f} s. {worst} is missing most often: it is known in"
        f" {100 * shares[worst]:.0f} % of the frames. Fill the gaps of its markers in the capture"
        " software and export again."
    )


def _cut(part: Part, first: int, end: int) -> Part:
    axes = None if part.axes is None else part.axes[first:end]
    return Part(part.centre_m[first:end], axes, part.seen[first:end])
