"""Fixtures with the running applications of the features' tests."""

from tests.features.conftest import fresh_lab, lab

__all__ = ["fresh_lab", "lab"]
