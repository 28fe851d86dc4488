"""What a headset measures of itself in a self-test, and the verdicts about it.

A self-test runs the room, the body's physics, the tracking and the sending of telemetry for two
minutes, as a session would, outside any phase. Its report is about the equipment: it names no
session and no participant.
"""

from datetime import datetime
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    StringConstraints,
    model_validator,
)

from app.plain_titles import made_plain
from app.platform.client_time import ClientTime
from app.wire import GOALS, Goal

Share = Annotated[float, Field(ge=0.0, le=1.0, allow_inf_nan=False)]
Seconds = Annotated[float, Field(ge=0.0, le=3600.0, allow_inf_nan=False)]
Rate = Annotated[float, Field(gt=0.0, le=1000.0, allow_inf_nan=False)]
Count = Annotated[int, Field(ge=0, le=10_000_000)]
ByteCount = Annotated[int, Field(ge=0, le=10**12)]
TestId = Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{32}$")]
Line = Annotated[str, StringConstraints(strip_whitespace=True, max_length=200)]
DeviceName = Annotated[
    Line,
    BeforeValidator(lambda name: made_plain(name) if isinstance(name, str) else name),
    StringConstraints(min_length=1),
]
"""A name as plain text: what was measured is not refused for the name it comes with."""
Input = Literal["controllers", "hands", "body", "shins", "trackers", "desktop", "scripted"]
Status = Literal["ok", "warn", "fail"]
SHARES_TOLERANCE = 0.01


class Figures(BaseModel):
    """Base of all parts of a report: frozen, without unknown fields."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class TestedDevice(Figures):
    """The device as its browser describes it.

    `name`: what people call it, such as "Quest 3", null if the browser does not tell. `inputs`:
    every source that moved the body during the test. `scripted` and `desktop` say that nobody wore
    the headset, and `screen` rendering that nothing was shown in it.
    """

    user_agent: Annotated[str, StringConstraints(min_length=1, max_length=500)]
    name: DeviceName | None = None
    inputs: Annotated[tuple[Input, ...], Field(max_length=7)] = ()


class RenderingFigures(Figures):
    """How regularly frames were shown, with the room, the mirror and the body drawn.

    `mode`: in the headset, or in a window on the screen. `nominal_rate_hz`: the rate that the
    device says it runs at, null if it does not tell. `frames`: frames of the render loop in the
    test. `mean_rate_hz`: frames per second, waiting included. `interval_*_s`: percentiles of the
    time from one frame to the next. `late_frames`: frames that came more than 1.5 nominal
    intervals after their predecessor; null if the nominal rate is not known.
    """

    mode: Literal["immersive", "screen"]
    nominal_rate_hz: Rate | None = None
    frames: Annotated[int, Field(ge=1, le=10_000_000)]
    mean_rate_hz: Rate
    interval_p50_s: Seconds
    interval_p95_s: Seconds
    interval_p99_s: Seconds
    interval_longest_s: Seconds
    late_frames: Count | None = None

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        _require_ascending(
            "interval",
            self.interval_p50_s,
            self.interval_p95_s,
            self.interval_p99_s,
            self.interval_longest_s,
        )
        if self.late_frames is not None and self.late_frames > self.frames:
            raise ValueError(f"late_frames ({self.late_frames}) exceeds frames ({self.frames})")
        return self


class PhysicsFigures(Figures):
    """How fast the body was computed: the model of a session, in the place where a session runs it.

    `model_hash` and `stature_m`: as received from the server. `where`: in a worker or in the page.
    `simulated_s`: simulated time. `real_time_factor`: simulated time divided by the time that its
    computing took, so 1 is the least with which a body can keep up. `frame_*_s`: percentiles of
    the computing time of one frame, inverse kinematics included. `resets`: how often the body was
    put back because its simulation had become invalid.
    """

    model_hash: Annotated[str, StringConstraints(pattern=r"^[0-9a-f]{64}$")]
    stature_m: Annotated[float, Field(ge=0.5, le=2.6, allow_inf_nan=False)]
    where: Literal["worker", "page"]
    simulated_s: Seconds
    real_time_factor: Annotated[float, Field(ge=0.0, le=100_000.0, allow_inf_nan=False)]
    frame_p50_s: Seconds
    frame_p95_s: Seconds
    frame_p99_s: Seconds
    resets: Count

    @model_validator(mode="after")
    def _ordered(self) -> Self:
        _require_ascending("frame", self.frame_p50_s, self.frame_p95_s, self.frame_p99_s)
        return self


class GoalFigures(Figures):
    """How one goal of the body was known during the test.

    `tracked`, `inferred`, `lost`: shares of the time, which add up to 1. `longest_loss_s`: the
    longest time without a break in which the goal was lost. `pose_rate_hz`: how often per second
    the pose changed; 0 for a goal that never moved.
    """

    tracked: Share
    inferred: Share
    lost: Share
    longest_loss_s: Seconds
    pose_rate_hz: Annotated[float, Field(ge=0.0, le=1000.0, allow_inf_nan=False)]

    @model_validator(mode="after")
    def _whole(self) -> Self:
        total = self.tracked + self.inferred + self.lost
        if abs(total - 1.0) > SHARES_TOLERANCE:
            raise ValueError(f"tracked, inferred and lost must add up to 1, not {total:.3f}")
        return self


class StorageFigures(Figures):
    """How telemetry of a session's size was sent and acknowledged, over the test's own socket.

    `batches` and `bytes`: what was sent. `acknowledged`: batches that the server said are on disk.
    `round_trip_*_s`: from the sending of a batch to its acknowledgement, over the acknowledged
    ones; null if none was. `bytes_per_s`: sent, over the time of sending. `journal_writes`: how
    often the headset wrote to its own journal, and `journal_write_p95_s` how long a write took;
    null if there was none.
    """

    batches: Count
    bytes: ByteCount
    acknowledged: Count
    round_trip_p50_s: Seconds | None = None
    round_trip_p95_s: Seconds | None = None
    round_trip_longest_s: Seconds | None = None
    bytes_per_s: Annotated[float, Field(ge=0.0, le=1e10, allow_inf_nan=False)]
    journal_writes: Count = 0
    journal_write_p95_s: Seconds | None = None

    @model_validator(mode="after")
    def _possible(self) -> Self:
        if self.acknowledged > self.batches:
            raise ValueError(f"acknowledged ({self.acknowledged}) exceeds batches ({self.batches})")
        times = (self.round_trip_p50_s, self.round_trip_p95_s, self.round_trip_longest_s)
        known = [time for time in times if time is not None]
        if len(known) != (len(times) if self.acknowledged else 0):
            raise ValueError("round trips are all given if a batch was acknowledged, else all null")
        _require_ascending("round_trip", *known)
        if (self.journal_write_p95_s is None) != (self.journal_writes == 0):
            raise ValueError("journal_write_p95_s is given if the journal was written, else null")
        return self


class PageFigures(Figures):
    """The page itself: its memory at the end in bytes, null if the browser does not tell.

    `errors`: errors that the page caught during the test, one line each, the first ten.
    """

    memory_bytes: ByteCount | None = None
    errors: Annotated[tuple[Line, ...], Field(max_length=10)] = ()


class SelfTestReport(Figures):
    """The report of a headset's self-test.

    `id`: 32 hexadecimal digits that the headset chooses at the test's start, so that a report that
    is sent again is not stored twice. `started_at`: UTC by the headset's clock. `duration_s`: what
    was measured, less than the planned 120 s if somebody stopped the test. `tracking`: all six
    goals. `physics`, `storage`: null if they could not be measured, which `page.errors` explains.
    """

    id: TestId
    started_at: ClientTime
    duration_s: Annotated[float, Field(ge=1.0, le=600.0, allow_inf_nan=False)]
    device: TestedDevice
    rendering: RenderingFigures
    physics: PhysicsFigures | None = None
    tracking: dict[Goal, GoalFigures]
    storage: StorageFigures | None = None
    page: PageFigures = PageFigures()

    @model_validator(mode="after")
    def _all_goals(self) -> Self:
        missing = [goal for goal in GOALS if goal not in self.tracking]
        if missing:
            raise ValueError(f"tracking must name all six goals; missing: {', '.join(missing)}")
        return self


VerdictCode = Literal[
    "duration",
    "rendering_rate",
    "late_frames",
    "longest_frame",
    "physics_speed",
    "physics_frame",
    "physics_resets",
    "head_loss",
    "hands_loss",
    "hands_tracked",
    "feet_tracked",
    "pose_rate",
    "unacknowledged",
    "round_trip",
    "page_errors",
]
Unit = Literal["", "s", "Hz", "%"]


class Verdict(Figures):
    """One figure of a report beside its limit.

    `code`: what is judged, see docs/headset-page.md. `value` is null if it was not measured, and
    `unit` is empty for a plain number. `limit`: the worst value that is still ok, or null if there
    is no number to compare with; `at_least` says on which side of it the value has to be.
    """

    code: VerdictCode
    status: Status
    value: float | None
    unit: Unit
    limit: float | None
    at_least: bool


class SelfTestView(BaseModel):
    """A stored self-test with its verdicts.

    `status`: the worst of the verdicts. `worn`: shown in a headset and moved by a person, so that
    it says something about this device; a test on a screen or by a script says that the page works.
    `received_at`: by the server's clock, which may be long after the test if the server was away.
    `clock_ahead_s`: how far the headset's clock is ahead at least, because a report cannot arrive
    before its test has ended; null up to a minute. A clock that is behind cannot be told from a
    report that waited.
    """

    id: str
    received_at: datetime
    status: Status
    worn: bool
    clock_ahead_s: float | None
    verdicts: tuple[Verdict, ...]
    report: SelfTestReport


def _require_ascending(what: str, *times_s: float) -> None:
    if any(first > second for first, second in pairwise(times_s)):
        raise ValueError(f"{what}: the percentiles must not descend, got {list(times_s)}")


class RunningTest(BaseModel):
    """A self-test that a session's headset makes now.

    `left_s`: how long it still measures, about; null until it has begun.
    """

    left_s: float | None
