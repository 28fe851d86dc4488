"""Describe alignments, as text and as JSON."""

import numpy as np

from app.cli.tracking.run import Aligned
from app.science.alignment import Alignment, PoseStream, Watched
from app.science.rotations import FloatArray, to_rotation_vector

_SAY = {
    "first": "aligned",
    "refit": "aligned again",
    "recentred": "aligned again after the headset was recentred",
    "moved": "the tracker moved on the head, or its system started anew: not aligned",
    "lost": "the headset was recentred: not aligned",
}


def as_json(done: Aligned) -> dict[str, object]:
    """Return what was found as JSON: metres, seconds, radians, quaternions w, x, y, z."""
    return {
        "headset": _stream_json(done.headset),
        "tracker": _stream_json(done.tracker),
        "changes": [_change_json(at_s, one) for at_s, one in done.changes],
        "alignment": None if done.last is None else _alignment_json(done.last),
        "moved": None
        if done.moved is None
        else {
            "file": str(done.moved.out),
            "written": done.moved.written,
            "left_out": done.moved.left_out,
        },
    }


def _stream_json(stream: PoseStream) -> dict[str, float]:
    duration_s = float(stream.times_s[-1] - stream.times_s[0])
    return {
        "samples": len(stream.times_s),
        "duration_s": duration_s,
        "rate_hz": 1.0 / float(np.median(np.diff(stream.times_s))),
    }


def _change_json(at_s: float, one: Watched) -> dict[str, object]:
    quality = one.alignment.quality if one.alignment is not None and one.holds else None
    return {
        "time_s": at_s,
        "change": one.change,
        "holds": one.holds,
        "uncertainty_m": None if quality is None else quality.uncertainty_m,
        "residual_p95_m": None if quality is None else quality.residual_p95_m,
        "jump": None
        if one.jump is None
        else {
            "time_s": one.jump.time_s,
            "side": one.jump.side,
            "offset_m": one.jump.offset_m,
            "offset_rad": one.jump.offset_rad,
        },
    }


def _alignment_json(found: Alignment) -> dict[str, object]:
    quality, looking = found.quality, found.quality.looking
    return {
        "headset_from_tracking": {
            "rotation_wxyz": found.rotation.tolist(),
            "position_m": found.position_m.tolist(),
            "drift_m_s": found.drift_m_s.tolist(),
            "reference_s": found.reference_s,
        },
        "tracker_from_head": {
            "rotation_wxyz": found.mount.rotation.tolist(),
            "position_m": found.mount.position_m.tolist(),
        },
        "delay_s": found.mount.delay_s,
        "delay_uncertainty_s": found.mount.delay_uncertainty_s,
        "start_s": found.start_s,
        "end_s": found.end_s,
        "samples": quality.samples,
        "outliers": quality.outliers,
        "residual_m": quality.residual_m,
        "residual_p95_m": quality.residual_p95_m,
        "residual_rad": quality.residual_rad,
        "residual_p95_rad": quality.residual_p95_rad,
        "uncertainty_m": quality.uncertainty_m,
        "condition": quality.condition,
        "looking": {
            "turn_rad": looking.turn_rad,
            "nod_rad": looking.nod_rad,
            "tilt_rad": looking.tilt_rad,
            "spread_rad": list(looking.spread_rad),
        },
    }


def as_text(done: Aligned) -> str:
    """Describe what was found for people: millimetres, milliseconds, degrees."""
    lines = [_change_text(at_s, one) for at_s, one in done.changes if one.change != "refit"]
    refits = sum(one.change == "refit" for _, one in done.changes)
    if refits:
        lines.append(f"and aligned again {refits} time(s) against drift")
    if done.last is not None:
        lines += ["", *_alignment_lines(done.last)]
    if done.moved is not None:
        lines += ["", f"written: {done.moved.out}, {done.moved.written} samples"]
        if done.moved.left_out:
            lines.append(
                f"left out: {done.moved.left_out} samples, where nothing was aligned or two"
                " alignments meet"
            )
    return "\n".join(lines)


def _change_text(at_s: float, one: Watched) -> str:
    text = f"{at_s:8.1f} s  {_SAY[one.change or 'refit']}"
    if one.jump is not None and not one.holds:
        text += (
            f" (by {one.jump.offset_m:.3f} m and {np.degrees(one.jump.offset_rad):.1f} degrees"
            f" at {one.jump.time_s:.2f} s)"
        )
    return text


def _alignment_lines(found: Alignment) -> list[str]:
    quality, looking = found.quality, found.quality.looking
    turn, nod, tilt = np.degrees((looking.turn_rad, looking.nod_rad, looking.tilt_rad))
    drift = found.drift_m_s * 1000.0
    rows = {
        "delay": f"{found.mount.delay_s * 1e3:.1f} ms, standard error"
        f" {found.mount.delay_uncertainty_s * 1e3:.1f} ms",
        "origin": f"{_listed(found.position_m)} m in the headset's world",
        "turned by": f"{_turned(found.rotation)}",
        "drift": f"{_listed(drift)} mm/s" if drift.any() else "none found",
        "head": f"{_listed(found.mount.position_m)} m in the tracker's axes",
        "residual": f"{quality.residual_m * 1e3:.1f} mm and"
        f" {np.degrees(quality.residual_rad):.2f} degrees (median);"
        f" {quality.residual_p95_m * 1e3:.1f} mm and"
        f" {np.degrees(quality.residual_p95_rad):.2f} degrees (95 %)",
        "outliers": f"{quality.outliers:.1%} of {quality.samples} samples",
        "foot": f"standard error {quality.uncertainty_m * 1e3:.1f} mm, 1.6 m from the head",
        "looked": f"{turn:.0f} degrees left and right, {nod:.0f} up and down, {tilt:.0f} tilted",
    }
    return [f"  {name:<12}{text}" for name, text in rows.items()]


def _turned(rotation: FloatArray) -> str:
    vector = to_rotation_vector(rotation)
    angle = float(np.linalg.norm(vector))
    axis = vector / angle if angle > 0.0 else vector
    return f"{np.degrees(angle):.2f} degrees about ({_listed(axis)})"


def _listed(vector: FloatArray) -> str:
    return ", ".join(f"{one:.3f}" for one in vector)
