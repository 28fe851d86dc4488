"""The real server on each engine, as in the tests of the headset, for participants' rights."""

from tests.features.record.headset.conftest import site

__all__ = ["site"]
