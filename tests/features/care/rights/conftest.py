"""The real server on each engine, as the headset's tests run it, for participants' rights."""

from tests.features.record.headset.conftest import site

__all__ = ["site"]
