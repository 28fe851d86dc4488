"""Format the results of `reembody tune`: JSON for scripts, a table for people."""

from collections.abc import Iterator
from itertools import islice
from typing import Any

from app.cli.tune.run import Tuned
from app.features.movement.tuning import report_json, summary_json
from app.science.avatar.tuning import (
    AxisTuning,
    Tracking,
    TuningReport,
)

_NONE = "-"
_MOST_TOUCHES = 8
_HEAD = (
    f"{'axis':<24}{'kp':>11}{'kd':>11}{'step':>6}{'overshoot':>11}{'settling':>10}{'rise':>8}"
    f"{'steady':>8}  status\n"
    f"{'':<24}{'N m/rad':>11}{'N m s/rad':>11}{'deg':>6}{'%':>11}{'s':>10}{'s':>8}{'deg':>8}"
)


def as_json(done: Tuned) -> dict[str, Any]:
    """Return the result for scripts; `axes` are in the order of the body."""
    report = report_json(done.report, done.tracking)
    return {**report, "cpu_s": round(done.cpu_s, 3), "saved": done.saved}


def as_text(done: Tuned) -> str:
    """Format the result for people."""
    report, figures = done.report, summary_json(done.report)
    lines = [_HEAD, *(_row(one) for one in report.axes), ""]
    if figures["tried"]:
        lines.append(
            f"Overshoot: median {figures['median_overshoot_percent']:.2f} %, worst"
            f" {figures['worst_overshoot_percent']:.2f} %, of {figures['tried']} axes."
        )
    if figures["greatest_torque_share"] is not None:
        lines.append(
            f"The relay experiments took at most {figures['greatest_torque_share']:.0%} of an axis'"
            " torque limit."
        )
    lines += [f"Warning, {one.name}: {one.warning}." for one in report.axes if one.warning]
    if done.tracking is not None:
        lines += [*_tracking_text("with nothing around", done.tracking.alone)]
        lines += [*_tracking_text("on a floor", done.tracking.on_floor), ""]
    words = ("tuned", "retried", "accepted", "flagged", "locked", "kept")
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
    for axis, share in islice(tracking.saturated.items(), _MOST_TOUCHES):
        yield f"  saturated: {axis} is at its torque limit in {share:.1%} of the frames"
    for touch, share in islice(tracking.touches.items(), _MOST_TOUCHES):
        yield f"  touches: {touch} in {share:.1%} of the frames"


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
