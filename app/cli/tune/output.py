"""What `reembody tune` says: JSON for scripts, a table for people."""

from collections.abc import Iterator
from dataclasses import asdict
from itertools import islice
from math import degrees, isnan
from statistics import median
from typing import TYPE_CHECKING, Any

from app.science.avatar.tuning import (
    Assessment,
    AxisTuning,
    Followed,
    Spread,
    Tracking,
    TuningReport,
)

if TYPE_CHECKING:
    from app.cli.tune.run import Tuned

_NONE = "-"
_MOST_TOUCHES = 8
_HEAD = (
    f"{'axis':<24}{'kp':>11}{'kd':>11}{'step':>6}{'overshoot':>11}{'settling':>10}{'rise':>8}"
    f"{'steady':>8}  status\n"
    f"{'':<24}{'N m/rad':>11}{'N m s/rad':>11}{'deg':>6}{'%':>11}{'s':>10}{'s':>8}{'deg':>8}"
)


def as_json(done: "Tuned") -> dict[str, Any]:
    """The result for scripts; `axes` in the order of the body."""
    told = report_json(done.report, done.tracking)
    return {**told, "cpu_s": round(done.cpu_s, 3), "saved": done.saved}


def report_json(report: TuningReport | Assessment, tracking: Followed | None) -> dict[str, Any]:
    """What is kept beside a tuned configuration: figures and the settings that led to them."""
    return {
        "axes": [_axis_json(one, tracking) for one in report.axes],
        "summary": _summary(report),
        "tracking": None if tracking is None else _followed_json(tracking),
        "stature_m": report.stature_m,
        "total_mass_kg": report.configuration.total_mass_kg,
        "options": asdict(report.options) if isinstance(report, TuningReport) else None,
        "wall_s": round(report.wall_s, 3),
    }


def as_text(done: "Tuned") -> str:
    """The result for people."""
    report, figures = done.report, _summary(done.report)
    lines = [_HEAD, *(_row(one) for one in report.axes), ""]
    if figures["tried"]:
        lines.append(
            f"Overshoot: median {figures['median_overshoot_percent']:.2f} %, worst"
            f" {figures['worst_overshoot_percent']:.2f} %, of {figures['tried']} axes."
        )
    if done.tracking is not None:
        lines += [*_tracking_text("with nothing around", done.tracking.alone)]
        lines += [*_tracking_text("on a floor", done.tracking.on_floor), ""]
    words = ("tuned", "retried", "accepted", "flagged", "locked")
    counts = ", ".join(f"{figures[word]} {word}" for word in words if word in figures)
    rule = f"rule {report.options.heuristic}" if isinstance(report, TuningReport) else "as given"
    lines.append(
        f"{counts}; {rule}, {report.stature_m:g} m, {report.configuration.total_mass_kg:g} kg;"
        f" {report.wall_s:.1f} s, {done.cpu_s:.1f} s of processor time."
    )
    if done.order.out is not None:
        lines.append(f"Written: {done.order.out}")
    if done.saved is not None:
        lines.append(f"Stored: {done.saved}")
    return "\n".join(lines)


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
        "rise_s": None if step is None else _rounded(step.rise_s),
        "steady_error_deg": None if step is None else round(step.steady_error_deg, 4),
        "step_deg": None if step is None else round(step.step_deg, 4),
        "rms_error_deg": None if tracking is None else tracking.alone.rms_deg.get(one.name),
        "attempts": one.attempts,
        "mirrored_from": one.mirrored_from,
        "relay": _relay_json(one),
    }


def _followed_json(followed: Followed) -> dict[str, Any]:
    return {**_tracking_json(followed.alone), "on_floor": _tracking_json(followed.on_floor)}


def _tracking_json(tracking: Tracking) -> dict[str, Any]:
    """`mean_error_deg` and `p95_error_deg` are of all samples against the clamped targets."""
    return {
        "mean_error_deg": tracking.mean_deg,
        "p95_error_deg": tracking.p95_deg,
        "free": _spread_json(tracking.free),
        "touching": _spread_json(tracking.touching),
        "unclamped": _spread_json(tracking.unclamped),
        "clipped_share": tracking.clipped_share,
        "touches": dict(tracking.touches),
        "frames": tracking.frames,
    }


def _spread_json(spread: Spread) -> dict[str, float | int | None]:
    return {
        "mean_error_deg": None if isnan(spread.mean_deg) else spread.mean_deg,
        "p95_error_deg": None if isnan(spread.p95_deg) else spread.p95_deg,
        "samples": spread.samples,
    }


def _tracking_text(where: str, tracking: Tracking) -> Iterator[str]:
    yield f"Angular error on the capture, {where}, {tracking.frames} frames:"
    for words, spread in (
        ("to the clamped targets", tracking.clamped),
        ("  of samples free of touch", tracking.free),
        ("  of samples in touch", tracking.touching),
        (f"to the unclamped ones ({tracking.clipped_share:.1%} clipped)", tracking.unclamped),
    ):
        figures = (
            f"mean {spread.mean_deg:5.2f} deg, 95 % within {spread.p95_deg:5.2f} deg"
            if spread.samples
            else "none"
        )
        yield f"  {words:<42}{figures}"
    for touch, share in islice(tracking.touches.items(), _MOST_TOUCHES):
        yield f"  touches: {touch} in {share:.1%} of the frames"


def _relay_json(one: AxisTuning) -> dict[str, Any] | None:
    if one.experiment is None:
        return None
    relay, found = one.experiment.relay, one.experiment.found
    return {
        "torque_nm": relay.torque_nm,
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


def _summary(report: TuningReport | Assessment) -> dict[str, Any]:
    statuses = [one.status.partition(":")[0] for one in report.axes]
    overshoots = [one.step.overshoot_percent for one in report.axes if one.step is not None]
    settled = [one.step.settling_s for one in report.axes if one.step is not None]
    times = [time for time in settled if time is not None]
    tuned = isinstance(report, TuningReport)
    words = (
        ("tuned", "retried", "flagged", "locked") if tuned else ("accepted", "flagged", "locked")
    )
    return {
        **{word: statuses.count(word) for word in (*words, "flagged", "locked")},
        "tried": len(overshoots),
        "median_overshoot_percent": round(median(overshoots), 3) if overshoots else None,
        "worst_overshoot_percent": round(max(overshoots), 3) if overshoots else None,
        "median_settling_s": _rounded(median(times)) if times else None,
        "worst_settling_s": _rounded(max(times)) if times else None,
    }


def _row(one: AxisTuning) -> str:
    head = f"{one.name:<24}{one.kp:>11.4g}{one.kd:>11.4g}"
    step = one.step
    if step is None:
        middle = f"{_NONE:>6}{_NONE:>11}{_NONE:>10}{_NONE:>8}{_NONE:>8}"
    else:
        middle = (
            f"{step.step_deg:>6.0f}{step.overshoot_percent:>11.2f}{_time(step.settling_s):>10}"
            f"{_time(step.rise_s):>8}{step.steady_error_deg:>8.2f}"
        )
    note = f" ({one.note})" if one.note else ""
    return f"{head}{middle}  {one.status}{note}"


def _time(seconds: float | None) -> str:
    return _NONE if seconds is None else f"{seconds:.3f}"


def _rounded(seconds: float | None) -> float | None:
    return None if seconds is None else round(seconds, 4)
