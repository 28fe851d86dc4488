"""Calibrations over HTTP."""

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
    """Every measurement, by equipment, the newest first."""
    return calibrations(db)


@router.post("", status_code=201)
def post_calibration(
    wish: NewCalibration, db: Writing, context: Context, caller: SignedIn
) -> CalibrationView:
    """Record a measurement of an equipment's own delay."""
    return add_calibration(db, wish, by=caller.actor, now=context.clock.utc_now())


@router.post("/{calibration_id}/retire")
def post_retirement(
    calibration_id: str, wish: Retirement, db: Writing, context: Context, caller: SignedIn
) -> CalibrationView:
    """Say that a measurement was a mistake; it stays in the history."""
    return retire_calibration(
        db, calibration_id, wish, by=caller.actor, now=context.clock.utc_now()
    )
