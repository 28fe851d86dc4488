"""Calibrations: appended, never edited.

The newest measurement of an equipment that was not retired is the one that holds. What latency a
study adds comes on top of it, so an export carries these numbers beside the data.
"""

from datetime import date, datetime
from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field, StringConstraints
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput, NotFound
from app.models import Calibration, new_id

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


MS_PER_S = 1000.0
_MS_DIGITS = 6
"""What is left after the way through seconds; far below what anybody can measure."""


def add_calibration(
    db: Session, wish: NewCalibration, *, by: str, now: datetime
) -> CalibrationView:
    """Store a measurement. Raises InvalidInput where it lies in the future."""
    if wish.measured_on > now.date():
        raise InvalidInput(
            "the measurement lies in the future",
            value=wish.measured_on.isoformat(),
            valid=f"up to {now.date().isoformat()}",
            remedy="Give the day on which it was measured.",
        )
    row = Calibration(
        id=new_id(),
        equipment=wish.equipment,
        motion_to_photon_s=wish.motion_to_photon_ms / MS_PER_S,
        sd_s=wish.sd_ms / MS_PER_S,
        samples=wish.samples,
        method=wish.method,
        measured_on=wish.measured_on.isoformat(),
        note=wish.note.strip(),
        by=by,
        at=now,
    )
    db.add(row)
    db.flush()
    return _one(db, row.id)


def calibrations(db: Session) -> list[CalibrationView]:
    """Every measurement, by equipment, the newest first."""
    rows = list(
        db.scalars(
            select(Calibration).order_by(
                Calibration.equipment,
                Calibration.measured_on.desc(),
                Calibration.at.desc(),
                Calibration.id,
            )
        )
    )
    current: dict[str, str] = {}
    for row in rows:
        if row.retired_at is None:
            current.setdefault(row.equipment, row.id)
    return [_view(row, current=current.get(row.equipment) == row.id) for row in rows]


def retire_calibration(
    db: Session, calibration_id: str, wish: Retirement, *, by: str, now: datetime
) -> CalibrationView:
    """Mark a measurement as a mistake. Raises NotFound, and Conflict where it was retired."""
    row = db.get(Calibration, calibration_id, with_for_update=True)
    if row is None:
        raise NotFound("there is no such calibration", value=calibration_id)
    if row.retired_at is not None:
        raise Conflict(
            "the calibration was retired already",
            value=row.retired_at.isoformat(),
            remedy="It stays in the history with its first reason.",
        )
    row.retired_at, row.retired_by, row.retired_reason = now, by, wish.reason
    db.flush()
    return _one(db, row.id)


def _one(db: Session, calibration_id: str) -> CalibrationView:
    return next(view for view in calibrations(db) if view.id == calibration_id)


def _view(row: Calibration, *, current: bool) -> CalibrationView:
    return CalibrationView(
        id=row.id,
        equipment=row.equipment,
        motion_to_photon_ms=round(row.motion_to_photon_s * MS_PER_S, _MS_DIGITS),
        sd_ms=round(row.sd_s * MS_PER_S, _MS_DIGITS),
        samples=row.samples,
        method=row.method,
        measured_on=datetime.fromisoformat(row.measured_on).date(),
        note=row.note,
        by=row.by,
        at=row.at,
        current=current,
        retired_at=row.retired_at,
        retired_by=row.retired_by,
        retired_reason=row.retired_reason,
    )
