"""Calibrations as they travel to a page: milliseconds at the edge, seconds inside."""

from datetime import date, datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, StringConstraints

Milliseconds = Annotated[float, Field(ge=0, le=10_000, allow_inf_nan=False)]
Line = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=120)]


class NewCalibration(BaseModel):
    """A measurement of one equipment's own delay from movement to picture.

    `sd_ms` is the standard deviation over the `samples` single measurements.
    """

    model_config = ConfigDict(extra="forbid")

    equipment: Line
    motion_to_photon_ms: Annotated[float, Field(gt=0, le=10_000, allow_inf_nan=False)]
    sd_ms: Milliseconds
    samples: int = Field(ge=1, le=1_000_000)
    method: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=400)]
    measured_on: date
    note: str = Field(default="", max_length=2000)


class Retirement(BaseModel):
    """Why a measurement must not be used any more."""

    model_config = ConfigDict(extra="forbid")

    reason: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=2000)]


class CalibrationView(BaseModel):
    """A stored measurement; `current` marks the one of its equipment that holds."""

    id: str
    equipment: str
    motion_to_photon_ms: float
    sd_ms: float
    samples: int
    method: str
    measured_on: date
    note: str
    by: str
    at: datetime
    current: bool
    retired_at: datetime | None
    retired_by: str | None
    retired_reason: str | None
