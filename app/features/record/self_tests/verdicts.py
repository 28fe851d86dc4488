"""The verdicts about a self-test: every figure that is judged, its limit and the reason for it.

This is the only place where a self-test is judged; the headset and the console show its result.

Sources: facts of the devices and of our own measurements are collected in docs/headset-page.md.
"""

from collections.abc import Callable
from dataclasses import dataclass

from app.features.record.self_tests.schemas import (
    GoalFigures,
    SelfTestReport,
    Status,
    Unit,
    Verdict,
    VerdictCode,
)
from app.wire import Goal

DEFAULT_RATE_HZ = {"immersive": 72.0, "screen": 60.0}
"""Where the device does not tell its rate: the lowest that headsets run at, and that of screens."""
HANDS: tuple[Goal, ...] = ("LeftHand", "RightHand")
FEET: tuple[Goal, ...] = ("LeftLowerLeg", "RightLowerLeg")
NOT_WORN = frozenset({"desktop", "scripted"})
SEVERITY: tuple[Status, ...] = ("ok", "warn", "fail")


@dataclass(frozen=True)
class Rule:
    """How one figure is judged.

    The value is ok up to `ok`, a warning up to `warn` and a failure beyond it, or never a failure
    if `warn` is None. `at_least`: larger is better. `of_rate`: a limit in frames per second is a
    share of the rate that the device should run at; `of_interval`: a limit in seconds is a multiple
    of the interval between its frames. A figure that was not measured is a `missing`, and so is one
    of the tracking (`when_worn`) where nothing was worn that could have been tracked.
    """

    code: VerdictCode
    value: Callable[[SelfTestReport], float | None]
    unit: Unit
    ok: float
    warn: float | None
    at_least: bool = False
    of_rate: bool = False
    of_interval: bool = False
    missing: Status = "warn"
    when_worn: bool = False


def rate_hz(report: SelfTestReport) -> float:
    """Return the frames per second that the device should show."""
    rendering = report.rendering
    return rendering.nominal_rate_hz or DEFAULT_RATE_HZ[rendering.mode]


def verdicts(report: SelfTestReport) -> tuple[Verdict, ...]:
    """Judge a report: one verdict for each rule, in the order of the table."""
    return tuple(_verdict(rule, report) for rule in RULES)


def worst(judged: tuple[Verdict, ...]) -> Status:
    """Return the worst status among the verdicts."""
    return max((verdict.status for verdict in judged), key=SEVERITY.index, default="ok")


def is_worn(report: SelfTestReport) -> bool:
    """Return whether the test was shown in a headset and moved by a person."""
    inputs = set(report.device.inputs)
    return report.rendering.mode == "immersive" and bool(inputs) and not inputs & NOT_WORN


def _verdict(rule: Rule, report: SelfTestReport) -> Verdict:
    unit_of_limit = 1.0
    if rule.of_rate:
        unit_of_limit = rate_hz(report)
    elif rule.of_interval:
        unit_of_limit = 1.0 / rate_hz(report)
    ok = rule.ok * unit_of_limit
    warn = None if rule.warn is None else rule.warn * unit_of_limit
    is_measured = is_worn(report) or not rule.when_worn
    value = rule.value(report) if is_measured else None
    return Verdict(
        code=rule.code,
        status=rule.missing if value is None else _status(value, ok, warn, at_least=rule.at_least),
        value=value,
        unit=rule.unit,
        limit=ok,
        at_least=rule.at_least,
    )


def _status(value: float, ok: float, warn: float | None, *, at_least: bool) -> Status:
    sign = -1.0 if at_least else 1.0
    if sign * value <= sign * ok:
        return "ok"
    return "warn" if warn is None or sign * value <= sign * warn else "fail"


def _late_percent(report: SelfTestReport) -> float | None:
    late = report.rendering.late_frames
    return None if late is None else 100.0 * late / report.rendering.frames


def _longest_loss_s(report: SelfTestReport, goals: tuple[Goal, ...]) -> float:
    return max(report.tracking[goal].longest_loss_s for goal in goals)


def _tracked_percent(report: SelfTestReport, goals: tuple[Goal, ...]) -> float:
    return 100.0 * min(report.tracking[goal].tracked for goal in goals)


def _pose_rate_hz(report: SelfTestReport) -> float | None:
    """Return the lowest rate among the head and the hands that were tracked at all."""
    seen: list[GoalFigures] = [report.tracking[goal] for goal in ("Head", *HANDS)]
    return min((figures.pose_rate_hz for figures in seen if figures.tracked > 0.0), default=None)


def _unacknowledged(report: SelfTestReport) -> float | None:
    storage = report.storage
    if storage is None or not storage.batches:
        return None
    return float(storage.batches - storage.acknowledged)


RULES: tuple[Rule, ...] = (
    # Two minutes show what heat and other programs do; less is a test that was stopped.
    Rule("duration", lambda r: r.duration_s, "s", 110.0, None, at_least=True),
    Rule(
        "rendering_rate",
        lambda r: r.rendering.mean_rate_hz,
        "Hz",
        0.95,
        0.80,
        at_least=True,
        of_rate=True,
    ),
    Rule("late_frames", _late_percent, "%", 1.0, 5.0),
    # A longer gap is not simulated (the body moves softly instead); 0.5 s counts as a sleep.
    Rule("longest_frame", lambda r: r.rendering.interval_longest_s, "s", 0.1, 0.5),
    # Below 1 the body falls behind. The margin is for a hotter headset and a busier scene.
    Rule(
        "physics_speed",
        lambda r: r.physics.real_time_factor if r.physics else None,
        "",
        1.5,
        1.0,
        at_least=True,
        missing="fail",
    ),
    # Longer than the interval, a pose is shown one frame later than recorded.
    Rule(
        "physics_frame",
        lambda r: r.physics.frame_p95_s if r.physics else None,
        "s",
        1.0,
        2.0,
        of_interval=True,
        missing="fail",
    ),
    Rule("physics_resets", lambda r: float(r.physics.resets) if r.physics else None, "", 0.0, 2.0),
    # Without the head there is no view. Hands leave the cameras' view for a moment in any task.
    Rule("head_loss", lambda r: _longest_loss_s(r, ("Head",)), "s", 0.2, 2.0, when_worn=True),
    Rule("hands_loss", lambda r: _longest_loss_s(r, HANDS), "s", 2.0, 10.0, when_worn=True),
    Rule(
        "hands_tracked",
        lambda r: _tracked_percent(r, HANDS),
        "%",
        90.0,
        50.0,
        at_least=True,
        when_worn=True,
    ),
    # Never a failure: a study without a foot task needs no feet, and pre-flight refuses the others.
    Rule(
        "feet_tracked",
        lambda r: _tracked_percent(r, FEET),
        "%",
        90.0,
        None,
        at_least=True,
        when_worn=True,
    ),
    # Hand tracking by cameras runs at 30 Hz or more; less adds more than 33 ms of latency.
    Rule("pose_rate", _pose_rate_hz, "Hz", 30.0, 15.0, at_least=True, when_worn=True),
    # Nothing that a participant does may be missing.
    Rule("unacknowledged", _unacknowledged, "", 0.0, 0.0, missing="fail"),
    # The server commits every 50 ms; the rest is the network. The live view is late by as much.
    Rule("round_trip", lambda r: r.storage.round_trip_p95_s if r.storage else None, "s", 0.25, 1.0),
    Rule("page_errors", lambda r: float(len(r.page.errors)), "", 0.0, None),
)
"""All that is judged, in the order in which it is shown."""
