"""HTTP endpoints for calibrations."""

from fastapi import APIRouter

from app.features.record.calibrations.service import (
    CalibrationView,
    NewCalibration,
    Retirement,
    add_calibration,
    calibrations,
    retire_calibration,
)
from app.platform.dependencies import Context, Reading, SignedIn, Writing

router = APIRouter(prefix="/calibrations", tags=["calibrations"])


@router.get("")
def get_calibrations(db: Reading, _: SignedIn) -> list[CalibrationView]:
    """Return all calibrations, sorted by equipment and then newest first."""
    return calibrations(db)


@router.post("", status_code=201)
def post_calibration(
    body: NewCalibration, db: Writing, context: Context, caller: SignedIn
) -> CalibrationView:
    """Store a measurement of the motion-to-photon delay of a piece of equipment."""
    return add_calibration(db, body, by=caller.actor, now=context.clock.utc_now())


@router.post("/{calibration_id}/retire")
def post_retirement(
    calibration_id: str, body: Retirement, db: Writing, context: Context, caller: SignedIn
) -> CalibrationView:
    """Mark a calibration as a mistake; it remains in the history."""
    return retire_calibration(
        db, calibration_id, body, by=caller.actor, now=context.clock.utc_now()
    )
