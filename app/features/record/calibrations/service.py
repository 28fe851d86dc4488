"""Calibrations: measurements of motion-to-photon delay, appended and never edited.

The newest measurement of a piece of equipment that was not retired is the current one. A study's
added latency comes on top of it, so an export contains these numbers along with the data.
"""

from datetime import date, datetime
from typing import Annotated

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, StringConstraints
from sqlalchemy import select
from sqlalchemy.orm import Session

from app.errors import Conflict, InvalidInput, NotFound
from app.models import Calibration, new_id
from app.plain_titles import plain

Milliseconds = Annotated[float, Field(ge=0, le=10_000, allow_inf_nan=False)]
Line = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=120)]


class NewCalibration(BaseModel):
    """A measurement of the motion-to-photon delay of one piece of equipment.

    `sd_ms` is the standard deviation over the `samples` individual measurements.
    """

    model_config = ConfigDict(extra="forbid")

    equipment: Annotated[Line, AfterValidator(plain)]
    motion_to_photon_ms: Annotated[float, Field(gt=0, le=10_000, allow_inf_nan=False)]
    sd_ms: Milliseconds
    samples: int = Field(ge=1, le=1_000_000)
    method: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=400)]
    measured_on: date
    note: str = Field(default="", max_length=2000)


class Retirement(BaseModel):
    """The reason why a calibration must no longer be used."""

    model_config = ConfigDict(extra="forbid")

    reason: Annotated[str, StringConstraints(strip_whitespace=True, min_length=1, max_length=2000)]


class CalibrationView(BaseModel):
    """A stored calibration; `current` marks the one in force for its equipment."""

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
"""Milliseconds are rounded to so many digits, which removes the errors of their conversion."""


def add_calibration(
    db: Session, body: NewCalibration, *, by: str, now: datetime
) -> CalibrationView:
    """Store a measurement; raises InvalidInput if its date is in the future."""
    if body.measured_on > now.date():
        raise InvalidInput(
            "the date of the measurement is in the future",
            value=body.measured_on.isoformat(),
            valid=f"up to {now.date().isoformat()}",
            remedy="Give the day on which it was measured.",
        )
    row = Calibration(
        id=new_id(),
        equipment=body.equipment,
        motion_to_photon_s=body.motion_to_photon_ms / MS_PER_S,
        sd_s=body.sd_ms / MS_PER_S,
        samples=body.samples,
        method=body.method,
        measured_on=body.measured_on.isoformat(),
        note=body.note.strip(),
        by=by,
        at=now,
    )
    db.add(row)
    db.flush()
    return _one(db, row.id)


def calibrations(db: Session) -> list[CalibrationView]:
    """Return all calibrations, sorted by equipment and then newest first."""
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
    db: Session, calibration_id: str, body: Retirement, *, by: str, now: datetime
) -> CalibrationView:
    """Mark a calibration as a mistake; raises NotFound, or Conflict if it was already retired."""
    row = db.get(Calibration, calibration_id, with_for_update=True)
    if row is None:
        raise NotFound("there is no such calibration", value=calibration_id)
    if row.retired_at is not None:
        raise Conflict(
            "the calibration was retired already",
            value=row.retired_at.isoformat(),
            remedy="It stays in the history with its first reason.",
        )
    row.retired_at, row.retired_by, row.retired_reason = now, by, body.reason
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
