"""The list of checks as pages see it. Words belong to the page: `code` names what was found."""

from datetime import datetime
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, StringConstraints

CheckKey = Literal[
    "tablet",
    "headset",
    "frame_rate",
    "clock",
    "trackers",
    "storage",
    "disk",
    "latency",
    "instruments",
    "configuration",
    "language",
]
CheckStatus = Literal["ok", "wait", "fail", "overridden"]
CheckCode = Literal[
    "tablet.unpaired",
    "tablet.away",
    "tablet.ok",
    "headset.unpaired",
    "headset.away",
    "headset.ok",
    "frame_rate.no_headset",
    "frame_rate.no_movement",
    "frame_rate.measuring",
    "frame_rate.low",
    "frame_rate.ok",
    "clock.no_headset",
    "clock.measuring",
    "clock.uncertain",
    "clock.ok",
    "trackers.no_movement",
    "trackers.frozen",
    "trackers.bad_values",
    "trackers.ok",
    "storage.failing",
    "storage.differs",
    "storage.ok",
    "disk.low",
    "disk.elsewhere",
    "disk.ok",
    "latency.unmeasured",
    "latency.calibrated",
    "latency.off",
    "latency.ok",
    "instruments.damaged",
    "instruments.none",
    "instruments.ok",
    "configuration.differs",
    "configuration.ok",
    "language.missing",
    "language.ok",
]
Expected = Literal["at_least", "at_most"]
Unit = Literal["s", "ms", "Hz", "GB", "joints", "phases", "instruments", "texts"]


class Override(BaseModel):
    """Somebody goes on all the same, although this was `found`."""

    reason: str
    found: CheckCode
    by: str
    at: datetime


class Check(BaseModel):
    """One line of the list.

    `wait`: it cannot be told yet, and comes by itself. `value` with its `unit` is what was found,
    `limit` with `expected` what it must keep to. `details` are names and hashes, in no language.
    `override`: the newest one; it counts while the finding is the one it was said of.
    """

    key: CheckKey
    status: CheckStatus
    code: CheckCode
    value: float | None = None
    unit: Unit | None = None
    expected: Expected | None = None
    limit: float | None = None
    details: tuple[str, ...] = ()
    override: Override | None = None


class Preflight(BaseModel):
    """The whole list, made anew. `clear`: nothing has failed, or what did was overridden.

    `asks`: whether a start with failures is asked about. Only sessions with people are: the others
    show the list and never stand in the way.
    """

    at: datetime
    clear: bool
    asks: bool
    checks: list[Check]


class OverrideRequest(BaseModel):
    """Go on although a check is not green."""

    model_config = ConfigDict(extra="forbid")

    check: CheckKey
    reason: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=2000)]
