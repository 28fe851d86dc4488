"""Pre-flight checks: conditions to be met before a participant puts the headset on."""

from app.features.record.preflight.checks import CHECKS, check_texts

__all__ = ["CHECKS", "check_texts"]
