"""Pre-flight checks: what should be in order before a participant puts the headset on."""

from app.features.record.preflight.checks import CHECKS, check_texts

__all__ = ["CHECKS", "check_texts"]
