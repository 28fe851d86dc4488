"""Self-tests of headsets: what a device measures of itself before people take part in it."""

from app.features.record.self_tests.schemas import RunningTest, SelfTestView
from app.features.record.self_tests.service import self_tests
from app.features.record.self_tests.storage import running_test

__all__ = [
    "RunningTest",
    "SelfTestView",
    "running_test",
    "self_tests",
]
