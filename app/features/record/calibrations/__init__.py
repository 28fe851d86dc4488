"""How slow the equipment itself is: measurements of its motion-to-photon delay."""

from app.features.record.calibrations.service import calibrations

__all__ = [
    "calibrations",
]
