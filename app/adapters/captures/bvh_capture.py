"""Read BVH as a capture: a rig and its movement in metres, y up.

BVH specifies neither its unit nor its upward axis. Exporters mostly write y up; the unit is the one
that gives the rest skeleton a human size, unless the user specifies it.
"""

from dataclasses import replace

import numpy as np

from app.adapters.bvh import BvhClip, BvhError, BvhLimits, parse_bvh_lines
from app.adapters.captures.axes import turned_rig_motion
from app.adapters.captures.capture import (
    Capture,
    CaptureError,
    Convention,
    Conventions,
    Limits,
    Reading,
)
from app.adapters.captures.tables import FARTHEST_M
from app.adapters.captures.text import text_lines
from app.adapters.captures.units import METRES_IN, chosen_axes, chosen_length, guess_length
from app.science.anatomy import Notice
from app.science.rig import Rig, RigMotion
from app.science.rotations import FloatArray, geodesic_angle, identity

_NOTICEABLE_M = 1e-4
_USUAL_UNIT = "cm"
_SHORTEST_FRAME_S, _LONGEST_FRAME_S = 1e-5, 1e3
# Pitching a ball turns the shoulder at about 120 rad/s (Fleisig et al. 1995); walking, below 20.
_FASTEST_JOINT_RAD_S = 120.0
_Y_UP = Convention("y up, right-handed", "format")


def read_bvh_capture(data: bytes, *, name: str, reading: Reading, limits: Limits) -> Capture:
    """Read a BVH file; see `app.adapters.bvh` for its grammar.

    Raises:
        CaptureError: the file cannot be read; the error gives the line and the reason.
    """
    del name
    bounds = BvhLimits(
        characters=limits.bytes, joints=limits.tracks, depth=limits.depth, values=limits.values
    )
    try:
        clip = parse_bvh_lines(text_lines(data), metres_per_unit=1.0, limits=bounds)
    except BvhError as error:
        raise CaptureError(error.reason, line=error.line) from error
    scale, length, notes, notices = _unit(clip, reading)
    _check_size(clip, scale)
    motion, more = _motion(clip, scale)
    notes += _doubt_about_up(clip, reading)
    orders = sorted({_order(channels) for channels in clip.channels if _order(channels)})
    conventions = Conventions(
        length=length,
        axes=chosen_axes(reading, _Y_UP),
        rotations=Convention(f"Euler {' and '.join(orders) or 'none'}, degrees", "file"),
        rate=Convention(f"{motion.rate_hz:.6g} Hz", "file"),
    )
    turned = turned_rig_motion(motion, reading.up or "y")
    return Capture("bvh", turned, conventions, (*notes, *more), notices)


def _order(channels: tuple[str, ...]) -> str:
    return "".join(channel[0] for channel in channels if channel.endswith("rotation"))


def _unit(
    clip: BvhClip, reading: Reading
) -> tuple[float, Convention, list[str], tuple[Notice, ...]]:
    """Return metres per unit, its origin, notes, and a notice if another unit than cm is guessed.

    BVH has no place for a unit. Most files are in centimetres; one in inches is 2.54 times as
    large, and nothing but the size of its body says so.
    """
    chosen = chosen_length(reading)
    if chosen is not None and reading.metres_per_unit is not None:
        return reading.metres_per_unit, chosen, [], ()
    guess = guess_length(float(np.max(_extents(clip))))
    convention = Convention(guess.name, "guessed")
    if guess.plausible:
        note = f"The file names no unit; in {guess.name} its rest pose spans {guess.size_m:.2f} m."
    else:
        note = (
            f"The file names no unit, and none makes its rest pose human: read in {guess.name} it"
            f" spans {guess.size_m:.3g} m. Say the unit if you know it."
        )
    if guess.plausible and guess.name == _USUAL_UNIT:
        return guess.metres_per_unit, convention, [note], ()
    times = guess.metres_per_unit / METRES_IN[_USUAL_UNIT]
    notice = Notice(
        "unit",
        "noted",
        "The file names no unit, so that of a body of human size was taken.",
        f"a rest pose of {guess.size_m:.3g} m if the unit is {guess.name}, which is {times:.3g}"
        f" times as large as in {_USUAL_UNIT}, the usual unit of BVH",
        f"0.85 m to 2.4 m{'' if guess.plausible else ', which no known unit gives'}",
        "If the person has another size, say the unit.",
    )
    return guess.metres_per_unit, convention, [note], (notice,)


def _extents(clip: BvhClip) -> FloatArray:
    """Return the rest pose's extent along x, y and z: arm span, height, depth."""
    places = clip.offsets_m.copy()
    for joint, parent in enumerate(clip.parents):
        if parent >= 0:
            places[joint] += places[parent]
    ends = [places[joint] + np.array(offset) for joint, offset in clip.end_sites]
    extents: FloatArray = np.ptp(np.vstack([places, *ends]), axis=0)
    return extents


def _doubt_about_up(clip: BvhClip, reading: Reading) -> list[str]:
    """Return a note if the rest pose is deeper than high: some exporters write z up."""
    _, height, depth = _extents(clip).tolist()
    if reading.up is not None or depth < 1.5 * height:
        return []
    return ["The rest pose is deeper than high: choose z as upward axis if the figure lies down."]


def _check_size(clip: BvhClip, scale: float) -> None:
    ends = [abs(value) for _, offset in clip.end_sites for value in offset]
    farthest = scale * max(
        float(np.abs(clip.offsets_m).max()), float(np.abs(clip.translations_m).max()), *ends, 0.0
    )
    if farthest > FARTHEST_M:
        raise CaptureError(
            f"an offset or position is {farthest:g} m, up to {FARTHEST_M:g} m is plausible:"
            " check the file and the unit."
        )


def _motion(clip: BvhClip, scale: float) -> tuple[RigMotion, list[str]]:
    offsets, notes = _offsets(clip, scale)
    rig = Rig(
        names=clip.names,
        parents=clip.parents,
        offsets_m=offsets,
        rest_rotations=identity(len(clip.names)),
        ends=tuple(
            (joint, (x * scale, y * scale, z * scale)) for joint, (x, y, z) in clip.end_sites
        ),
    )
    rate_hz = _rate(clip.frame_time_s)
    motion = RigMotion(
        rig=rig,
        rate_hz=rate_hz,
        root_positions_m=clip.root_positions_m * scale,
        rotations=clip.rotations,
        observed=np.ones(clip.rotations.shape[:2], dtype=np.bool_),
    )
    trimmed = without_rest_row(motion)
    if trimmed is not motion:
        notes.append("The first row is a rest pose put before the movement: it was left out.")
    return trimmed, notes


def _offsets(clip: BvhClip, scale: float) -> tuple[FloatArray, list[str]]:
    """Return constant bone offsets: the median position for joints with position channels.

    Also returns notes on these joints.
    """
    offsets = clip.offsets_m * scale
    notes: list[str] = []
    moving = [
        joint
        for joint, channels in enumerate(clip.channels)
        if joint > 0 and any(channel.endswith("position") for channel in channels)
    ]
    worst, at = 0.0, ""
    for joint in moving:
        places = clip.translations_m[:, joint] * scale
        offsets[joint] = np.median(places, axis=0)
        apart = float(np.linalg.norm(places - offsets[joint], axis=-1).max())
        if apart > worst:
            worst, at = apart, clip.names[joint]
    if moving:
        notes.append(
            f"{len(moving)} joints besides the root have position channels: the median became"
            " their bone's offset"
            + (f", which {at} leaves by up to {worst:.4f} m." if worst > _NOTICEABLE_M else ".")
        )
    return offsets, notes


def _rate(frame_time_s: float) -> float:
    """Return the frame rate, a whole number if rounding in the file allows it.

    For example, 0.008333 s is 120 Hz.
    """
    if not _SHORTEST_FRAME_S <= frame_time_s <= _LONGEST_FRAME_S:
        raise CaptureError(
            f"frame time {frame_time_s:g} s: {_SHORTEST_FRAME_S:f} to {_LONGEST_FRAME_S:g} s is"
            " valid."
        )
    whole = max(round(1.0 / frame_time_s), 1)
    # Exporters write at least six decimals.
    return float(whole) if abs(frame_time_s - 1.0 / whole) <= 5e-7 else 1.0 / frame_time_s


def without_rest_row(motion: RigMotion) -> RigMotion:
    """Drop a T-pose that some converters insert before the movement.

    It is recognised because the second frame would require an impossible joint speed.
    """
    if motion.frame_count > 2:
        turned = geodesic_angle(motion.rotations[0], motion.rotations[1])
        if float(np.max(turned)) * motion.rate_hz > _FASTEST_JOINT_RAD_S:
            return replace(
                motion,
                root_positions_m=motion.root_positions_m[1:],
                rotations=motion.rotations[1:],
                observed=motion.observed[1:],
            )
    return motion
