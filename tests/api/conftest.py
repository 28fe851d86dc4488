"""The applications of the features' tests, for tests that concern all routes."""

from tests.features.conftest import fresh_lab, lab

__all__ = ["fresh_lab", "lab"]
