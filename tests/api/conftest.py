"""Fixtures with the running applications of the features' tests, for tests of all routes."""

from tests.features.conftest import fresh_lab, lab

__all__ = ["fresh_lab", "lab"]
