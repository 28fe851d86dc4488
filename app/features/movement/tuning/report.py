"""Convert a tuning to JSON, for scripts, pages and storage with the tuned configuration."""

from dataclasses import asdict
from math import degrees, isnan
from statistics import median
from typing import Any

from app.science.avatar.tuning import (
    Assessment,
    AxisTuning,
    Followed,
    Spread,
    Tracking,
    TuningOptions,
    TuningReport,
)

_NAMED_AXES = 4


def report_json(report: TuningReport | Assessment, tracking: Followed | None) -> dict[str, Any]:
    """Return the report stored with a tuned configuration: figures, and the options used."""
    return {
        "axes": [_axis_json(one, tracking) for one in report.axes],
        "summary": summary_json(report),
        "tracking": None if tracking is None else followed_json(tracking),
        "stature_m": report.stature_m,
        "total_mass_kg": report.configuration.total_mass_kg,
        "options": asdict(report.options) if isinstance(report, TuningReport) else None,
        "wall_s": round(report.wall_s, 3),
    }


def _axis_json(one: AxisTuning, tracking: Followed | None) -> dict[str, Any]:
    step = one.step
    return {
        "name": one.name,
        "kp": one.kp,
        "kd": one.kd,
        "overshoot_percent": None if step is None else round(step.overshoot_percent, 3),
        "settling_s": None if step is None else _rounded(step.settling_s),
        "status": one.status,
        "note": one.note,
        "warning": one.warning,
        "rise_s": None if step is None else _rounded(step.rise_s),
        "steady_error_deg": None if step is None else round(step.steady_error_deg, 4),
        "step_deg": None if step is None else round(step.step_deg, 4),
        "rms_error_deg": None if tracking is None else tracking.alone.rms_deg.get(one.name),
        "attempts": one.attempts,
        "mirrored_from": one.mirrored_from,
        "relay": _relay_json(one),
    }


def followed_json(followed: Followed) -> dict[str, Any]:
    """Return the errors on a movement: in an empty space, and under `on_floor` on a floor."""
    return {**_tracking_json(followed.alone), "on_floor": _tracking_json(followed.on_floor)}


def _tracking_json(tracking: Tracking) -> dict[str, Any]:
    """Return one tracking's figures.

    `mean_error_deg` and `p95_error_deg` are of all samples against the clamped targets.
    """
    return {
        "mean_error_deg": tracking.mean_deg,
        "p95_error_deg": tracking.p95_deg,
        "free": _spread_json(tracking.free),
        "touching": _spread_json(tracking.touching),
        "unclamped": _spread_json(tracking.unclamped),
        "clipped_share": tracking.clipped_share,
        "saturated": dict(tracking.saturated),
        "touches": dict(tracking.touches),
        "frames": tracking.frames,
    }


def _spread_json(spread: Spread) -> dict[str, float | int | None]:
    return {
        "mean_error_deg": None if isnan(spread.mean_deg) else spread.mean_deg,
        "p95_error_deg": None if isnan(spread.p95_deg) else spread.p95_deg,
        "samples": spread.samples,
    }


def _relay_json(one: AxisTuning) -> dict[str, Any] | None:
    if one.experiment is None:
        return None
    push, relay, found = one.experiment.push, one.experiment.relay, one.experiment.found
    return {
        "torque_nm": relay.torque_nm,
        "torque_from": "chosen" if push.chosen else "ramp",
        "peak_torque_nm": found.peak_torque_nm,
        "swing_deg": degrees(push.swing_rad),
        "reach_s": push.reach_s,
        "damping_nm_s": relay.damping_nm_s,
        "hysteresis_deg": round(degrees(relay.hysteresis_rad), 9),
        "warm_up_cycles": relay.warm_up_cycles,
        "cycles": relay.cycles,
        "step_s": relay.step_s,
        "pose": one.experiment.pose,
        "aimed_hz": one.experiment.aimed_hz,
        "amplitude_deg": degrees(found.amplitude_rad),
        "period_s": found.period_s,
        "ultimate_gain_nm_rad": found.ultimate_gain_nm_rad,
        "inertia_kg_m2": found.inertia_kg_m2,
        "simulated_s": round(found.simulated_s, 6),
    }


def summary_json(report: TuningReport | Assessment) -> dict[str, Any]:
    """Return the number of axes per status, and statistics over all tested axes.

    `greatest_torque_share` is that of relay and damping in the limit of their axis.
    """
    statuses = [one.status.partition(":")[0] for one in report.axes]
    overshoots = [one.step.overshoot_percent for one in report.axes if one.step is not None]
    settled = [one.step.settling_s for one in report.axes if one.step is not None]
    times = [time for time in settled if time is not None]
    shares = [
        one.experiment.found.peak_torque_nm / report.configuration.axes[one.name].max_torque_nm
        for one in report.axes
        if one.experiment is not None
    ]
    tuned = isinstance(report, TuningReport)
    words = (
        ("tuned", "retried", "flagged", "locked", "kept")
        if tuned
        else ("accepted", "flagged", "locked")
    )
    return {
        **{word: statuses.count(word) for word in (*words, "flagged", "locked")},
        "tried": len(overshoots),
        "median_overshoot_percent": round(median(overshoots), 3) if overshoots else None,
        "worst_overshoot_percent": round(max(overshoots), 3) if overshoots else None,
        "median_settling_s": _rounded(median(times)) if times else None,
        "worst_settling_s": _rounded(max(times)) if times else None,
        "greatest_torque_share": round(max(shares), 3) if shares else None,
    }


def tuning_note(
    options: TuningOptions, stature_m: float, accepted: tuple[int, int] | None = None
) -> str:
    """Return the note of a stored version that was tuned like this.

    `accepted`: how many axes were accepted, and of how many; None if all were.
    """
    chosen = "" if options.axes is None else f", {len(options.axes)} axes chosen"
    if accepted is not None:
        chosen += f", {accepted[0]} of {accepted[1]} axes accepted"
    return (
        f"tuned by {options.heuristic} on a body of {stature_m:g} m{chosen}; relay torques"
        f" {_origin_of_torques(options)}"
    )


def _origin_of_torques(options: TuningOptions) -> str:
    """Return how the relay's torques were found: by the ramp, or by hand for some or all axes."""
    by_axis = options.relay_torques_nm
    if options.relay_torque_nm is not None:
        return "chosen by hand"
    if not by_axis:
        return "found by a ramp"
    if len(by_axis) > _NAMED_AXES:
        return f"found by a ramp, except those of {len(by_axis)} axes, chosen by hand"
    named = ", ".join(f"{axis} {torque_nm:g} N m" for axis, torque_nm in by_axis.items())
    return f"found by a ramp, except those chosen by hand: {named}"


def _rounded(seconds: float | None) -> float | None:
    return None if seconds is None else round(seconds, 4)
