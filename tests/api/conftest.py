"""The application of the feature tests, for tests of what stands around all routes."""

from tests.features.conftest import fresh_lab, lab

__all__ = ["fresh_lab", "lab"]
