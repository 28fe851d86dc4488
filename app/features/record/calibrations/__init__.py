"""Calibrations: measurements of the equipment's own motion-to-photon delay."""

from app.features.record.calibrations.service import calibrations

__all__ = [
    "calibrations",
]
