"""Fixtures with a real server on each engine, for the tests of participants' rights."""

from tests.features.record.headset.conftest import site

__all__ = ["site"]
