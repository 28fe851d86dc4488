"""The pre-flight checks, and the registry of them all."""

from app.features.record.preflight.checks.registry import CHECKS, check_texts

__all__ = ["CHECKS", "check_texts"]
