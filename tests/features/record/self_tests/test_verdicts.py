"""Tests of the verdicts about a self-test: which figure is judged how, and at which limit."""

import re
from pathlib import Path
from typing import Any

import pytest
from pydantic import ValidationError

from app.features.record.self_tests.schemas import SelfTestReport, Verdict
from app.features.record.self_tests.verdicts import RULES, is_worn, verdicts, worst
from tests.features.record.self_tests.reports import GOOD, TRACKED, parsed, report

PAGE = (Path(__file__).parents[4] / "docs/headset-page.md").read_text(encoding="utf-8")


def of(code: str, **changes: Any) -> Verdict:
    """Return one verdict about the changed report."""
    return next(one for one in verdicts(parsed(**changes)) if one.code == code)


def lost(longest_s: float, share: float = 0.05) -> dict[str, float]:
    """Return the figures of a goal that was lost at times."""
    return {**TRACKED, "tracked": 1.0 - share, "lost": share, "longest_loss_s": longest_s}


def test_a_good_headset_is_ok_in_every_figure() -> None:
    """The report of a good headset gets one verdict for each rule, and each is ok."""
    judged = verdicts(parsed())
    assert [one.code for one in judged] == [rule.code for rule in RULES]
    assert {one.status for one in judged} == {"ok"}
    assert all(one.value is not None and one.limit is not None for one in judged)


def test_the_docs_name_every_rule_with_its_limits() -> None:
    """The table in docs/headset-page.md has a row for each rule, in order, with both limits."""
    rows = re.findall(r"^\| `(\w+)` \| [^|]+ \| ([^|]+) \|([^|]*)\|", PAGE, re.MULTILINE)
    expected = [
        (rule.code, rule.at_least, f"{rule.ok:g}", "" if rule.warn is None else f"{rule.warn:g}")
        for rule in RULES
    ]
    number = re.compile(r"[\d.]+")
    documented = [
        (code, fine.startswith("at least"), number.findall(fine)[0], "".join(number.findall(bad)))
        for code, fine, bad in rows
    ]
    assert documented == expected


LIMITS: list[tuple[str, str, list[tuple[float, str]]]] = [
    ("duration", "duration_s", [(110.0, "ok"), (109.9, "warn"), (1.0, "warn")]),
    (
        "rendering_rate",
        "rendering__mean_rate_hz",
        [(85.5, "ok"), (85.4, "warn"), (72.0, "warn"), (71.9, "fail")],
    ),
    ("late_frames", "rendering__late_frames", [(107, "ok"), (108, "warn"), (540, "fail")]),
    (
        "longest_frame",
        "rendering__interval_longest_s",
        [(0.1, "ok"), (0.11, "warn"), (0.5, "warn"), (0.51, "fail")],
    ),
    (
        "physics_speed",
        "physics__real_time_factor",
        [(1.5, "ok"), (1.49, "warn"), (1.0, "warn"), (0.99, "fail")],
    ),
    (
        "physics_resets",
        "physics__resets",
        [(0, "ok"), (1, "warn"), (2, "warn"), (3, "fail")],
    ),
    (
        "unacknowledged",
        "storage__acknowledged",
        [(2400, "ok"), (2399, "fail")],
    ),
    ("head_loss", "tracking__Head", [(0.2, "ok"), (0.3, "warn"), (2.1, "fail")]),
    ("hands_loss", "tracking__LeftHand", [(2.0, "ok"), (2.1, "warn"), (10.1, "fail")]),
]


@pytest.mark.parametrize(("code", "field", "cases"), LIMITS, ids=[one[0] for one in LIMITS])
def test_each_limit_separates_its_statuses(
    code: str, field: str, cases: list[tuple[float, str]]
) -> None:
    """A value at a limit still has the better status, and the next worse one has the worse."""
    for value, status in cases:
        figures = lost(value) if field.startswith("tracking") else value
        assert of(code, **{field: figures}).status == status, (code, value)


def test_the_limits_follow_the_devices_own_rate() -> None:
    """At 72 Hz a frame may take 13.9 ms; without a known rate the lowest of the mode counts."""
    at_72 = of("physics_frame", rendering__nominal_rate_hz=72.0)
    assert at_72.limit == pytest.approx(1 / 72)
    unknown = {"rendering__nominal_rate_hz": None, "rendering__late_frames": None}
    assert of("rendering_rate", **unknown).limit == pytest.approx(0.95 * 72.0)
    assert of("late_frames", **unknown).status == "warn"
    on_screen = {"rendering__mode": "screen", **unknown}
    assert of("rendering_rate", **on_screen).limit == pytest.approx(0.95 * 60.0)
    slow = {"physics__frame_p95_s": 0.012, "physics__frame_p99_s": 0.02}
    assert of("physics_frame", rendering__nominal_rate_hz=72.0, **slow).status == "ok"
    assert of("physics_frame", rendering__nominal_rate_hz=90.0, **slow).status == "warn"
    assert of("physics_frame", rendering__nominal_rate_hz=200.0, **slow).status == "fail"


def test_what_was_not_measured_is_never_ok() -> None:
    """Without physics or storage their verdicts say so; only what can be judged has a value."""
    judged = {one.code: one for one in verdicts(parsed(physics=None, storage=None))}
    assert (judged["physics_speed"].status, judged["physics_speed"].value) == ("fail", None)
    assert (judged["unacknowledged"].status, judged["unacknowledged"].value) == ("fail", None)
    assert judged["round_trip"].status == "warn"
    assert worst(tuple(judged.values())) == "fail"
    nothing_sent = {
        **GOOD["storage"],
        **dict.fromkeys(("batches", "bytes", "acknowledged"), 0),
        **dict.fromkeys(("round_trip_p50_s", "round_trip_p95_s", "round_trip_longest_s")),
    }
    assert of("unacknowledged", storage=nothing_sent).status == "fail"


def test_feet_that_are_not_tracked_are_a_warning_only() -> None:
    """A headset without feet is good for studies without a foot task, so it does not fail."""
    inferred = {**TRACKED, "tracked": 0.0, "inferred": 1.0}
    judged = of("feet_tracked", tracking__LeftLowerLeg=inferred)
    assert (judged.status, judged.value, judged.unit) == ("warn", 0.0, "%")
    still = {**TRACKED, "tracked": 0.0, "inferred": 1.0, "pose_rate_hz": 0.0}
    both = {"tracking__LeftHand": still, "tracking__RightHand": still}
    assert of("pose_rate", **both).value == 90.0
    assert of("hands_tracked", **both).status == "fail"


@pytest.mark.parametrize(("mode", "inputs"), [("immersive", ["scripted"]), ("screen", ["desktop"])])
def test_tracking_is_not_measured_where_nothing_was_worn(mode: str, inputs: list[str]) -> None:
    """A script or a mouse is tracked without fault, which says nothing about the device."""
    judged = verdicts(parsed(rendering__mode=mode, device__inputs=inputs))
    unmeasured = {one.code for one in judged if one.value is None}
    tracking = {"head_loss", "hands_loss", "hands_tracked", "feet_tracked", "pose_rate"}
    assert unmeasured == tracking
    assert {one.status for one in judged if one.code in tracking} == {"warn"}
    assert {one.status for one in judged if one.code not in tracking} == {"ok"}


@pytest.mark.parametrize("inputs", [["hands", "body"], ["controllers"]])
def test_a_person_in_a_headset_has_worn_it(inputs: list[str]) -> None:
    """A test that was shown in a headset and moved by a person says something about the device."""
    assert is_worn(parsed(device__inputs=inputs))


@pytest.mark.parametrize(
    ("mode", "inputs"),
    [
        ("immersive", ["scripted"]),
        ("immersive", ["hands", "scripted"]),
        ("immersive", []),
        ("screen", ["desktop"]),
        ("screen", ["hands"]),
    ],
)
def test_a_screen_or_a_script_wears_nothing(mode: str, inputs: list[str]) -> None:
    """A test on a screen, by a script or without any input says nothing about the device."""
    assert not is_worn(parsed(rendering__mode=mode, device__inputs=inputs))


@pytest.mark.parametrize(
    ("path", "value"),
    [
        ("id", "not hexadecimal"),
        ("started_at", "2026-03-02T09:00:00"),
        ("duration_s", 601.0),
        ("duration_s", float("nan")),
        ("rendering__frames", 0),
        ("rendering__mean_rate_hz", float("inf")),
        ("rendering__interval_p95_s", 0.001),
        ("rendering__late_frames", 10_791),
        ("rendering__extra", 1),
        ("physics__frame_p50_s", 0.02),
        ("physics__model_hash", "a"),
        ("tracking__Hips", {**TRACKED, "lost": 0.5}),
        ("tracking", {"Head": TRACKED}),
        ("tracking__Tail", TRACKED),
        ("storage__acknowledged", 2401),
        ("storage__round_trip_p50_s", None),
        ("storage__journal_write_p95_s", None),
        ("storage__journal_writes", 0),
        ("storage__round_trip_p50_s", 0.2),
        ("page__errors", ["x"] * 11),
        ("page__errors", ["x" * 201]),
        ("device__inputs", ["telepathy"]),
        ("device__user_agent", ""),
    ],
)
def test_a_report_that_cannot_be_is_refused(path: str, value: object) -> None:
    """A report with a figure out of range or in contradiction to another is refused."""
    with pytest.raises(ValidationError):
        SelfTestReport.model_validate(report(**{path: value}))
