"""Refuse reports of self-tests whose figures contradict each other or the server's clock.

The verdicts judge one figure at a time, so figures that cannot belong together would be judged ok.
Reports that are stored already are not checked again.
"""

from collections.abc import Iterator
from datetime import datetime, timedelta

from app.errors import InvalidInput
from app.features.record.self_tests.schemas import GoalFigures, SelfTestReport

AHEAD = timedelta(days=1)
"""How far a headset's clock may be ahead. A report of the past may have waited for its server."""
RATES_HZ = (30.0, 240.0)
"""The rates at which headsets and screens run."""
RATE_FACTOR = 1.5
"""Between the mean rate and frames / duration: rendering may start and end beside the rest."""
LOSS_TOLERANCE_S = 1.0
LOSS_TOLERANCE = 0.02
"""Of the duration, beside a second: tracking may start and end beside the rest."""


def require_consistent(report: SelfTestReport, *, now: datetime) -> None:
    """Raise InvalidInput, with all fields that cannot be true, if a report contradicts itself."""
    problems = [
        {"place": place, "problem": words}
        for found in (_of_clock(report, now), _of_rendering(report), _of_tracking(report))
        for place, words in found
    ]
    if problems:
        raise InvalidInput(
            "the figures of this self-test cannot all be true: "
            + "; ".join(f"{one['place']}: {one['problem']}" for one in problems),
            value=report.id,
            remedy="Reload the headset's page and run the self-test again.",
            details=problems,
        )


def _of_clock(report: SelfTestReport, now: datetime) -> Iterator[tuple[str, str]]:
    latest = now + AHEAD
    if report.started_at > latest:
        yield (
            "started_at",
            (
                f"{report.started_at.isoformat()} is more than a day ahead of the server's "
                f"clock; it must be at most {latest.isoformat()}. Set the clock of the headset"
            ),
        )


def _of_rendering(report: SelfTestReport) -> Iterator[tuple[str, str]]:
    rendering = report.rendering
    nominal_hz, (low_hz, high_hz) = rendering.nominal_rate_hz, RATES_HZ
    if nominal_hz is not None and not low_hz <= nominal_hz <= high_hz:
        yield (
            "rendering.nominal_rate_hz",
            f"{nominal_hz:g} Hz is no rate of a headset; it must be {low_hz:g} to {high_hz:g} Hz",
        )
    frames = rendering.mean_rate_hz * report.duration_s
    low, high = frames / RATE_FACTOR - 1.0, frames * RATE_FACTOR + 1.0
    if not low <= rendering.frames <= high:
        yield (
            "rendering.frames",
            (
                f"{rendering.frames} in {report.duration_s:g} s does not fit a mean rate of "
                f"{rendering.mean_rate_hz:g} Hz; it must be {max(1.0, low):.0f} to {high:.0f}"
            ),
        )


def _of_tracking(report: SelfTestReport) -> Iterator[tuple[str, str]]:
    for goal, figures in report.tracking.items():
        words = _loss_problem(figures, report.duration_s)
        if words is not None:
            yield f"tracking.{goal}.longest_loss_s", words


def _loss_problem(figures: GoalFigures, duration_s: float) -> str | None:
    """Return what is wrong with the longest loss beside the share of the time that was lost."""
    lost_s = figures.lost * duration_s
    tolerance_s = LOSS_TOLERANCE_S + LOSS_TOLERANCE * duration_s
    longest_s = figures.longest_loss_s
    if longest_s > lost_s + tolerance_s:
        return f"{longest_s:g} s is longer than all losses together ({lost_s:.3g} s)"
    # Between two losses the goal is known, so a goal that is never known is lost without a break.
    known_s = duration_s - lost_s
    if lost_s > tolerance_s and longest_s == 0.0:
        return f"0 s, although the goal was lost for {lost_s:.3g} s"
    if known_s <= 0.0 and longest_s < lost_s - tolerance_s:
        return f"{longest_s:g} s, although the goal was lost all the time ({lost_s:.3g} s)"
    return None
