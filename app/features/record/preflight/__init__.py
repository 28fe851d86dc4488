"""Pre-flight checks: conditions to be met before a participant puts the headset on."""

from app.features.record.preflight.checks import CHECKS, check_texts
from app.features.record.preflight.service import overrides_of

__all__ = ["CHECKS", "check_texts", "overrides_of"]
