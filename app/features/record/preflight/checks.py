"""The registry of the pre-flight checks, in the order of the list.

A new check stands in one of the files imported here, or in a new one, and gets its place in
`CHECKS`: the interface, the list in the cockpit and its words in both languages follow from that.
"""

from app.features.record.preflight.check import PreflightCheck
from app.features.record.preflight.device_checks import (
    CLOCK,
    FRAME_RATE,
    HEADSET,
    TABLET,
    TRACKERS,
)
from app.features.record.preflight.latency_check import LATENCY
from app.features.record.preflight.storage_checks import DISK, STORAGE
from app.features.record.preflight.study_checks import CONFIGURATION, INSTRUMENTS, LANGUAGE
from app.texts import Words

CHECKS: tuple[PreflightCheck, ...] = (
    TABLET,
    HEADSET,
    FRAME_RATE,
    CLOCK,
    TRACKERS,
    STORAGE,
    DISK,
    LATENCY,
    INSTRUMENTS,
    CONFIGURATION,
    LANGUAGE,
)


def check_texts() -> dict[str, Words]:
    """The words of every check, by their keys in the tables of the pages."""
    return {key: words for check in CHECKS for key, words in check.texts().items()}
