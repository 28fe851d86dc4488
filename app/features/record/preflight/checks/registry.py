"""The registry of pre-flight checks, in the order of the list.

To add a check, define it in one of the modules imported here or in a new one, and add it to
`CHECKS`. The interface, the list in the cockpit and its texts in both languages are derived from
that.
"""

from app.features.record.preflight.check import PreflightCheck
from app.features.record.preflight.checks.device import (
    CLOCK,
    FRAME_RATE,
    HEADSET,
    TABLET,
    TRACKERS,
)
from app.features.record.preflight.checks.feet import FEET
from app.features.record.preflight.checks.lab_trackers import LAB_TRACKERS
from app.features.record.preflight.checks.latency import LATENCY
from app.features.record.preflight.checks.road import ROAD
from app.features.record.preflight.checks.storage import DISK, STORAGE
from app.features.record.preflight.checks.study import CONFIGURATION, INSTRUMENTS, LANGUAGE
from app.texts import Words

CHECKS: tuple[PreflightCheck, ...] = (
    TABLET,
    HEADSET,
    FRAME_RATE,
    CLOCK,
    TRACKERS,
    LAB_TRACKERS,
    FEET,
    STORAGE,
    DISK,
    LATENCY,
    ROAD,
    INSTRUMENTS,
    CONFIGURATION,
    LANGUAGE,
)


def check_texts() -> dict[str, Words]:
    """Return the texts of all checks by their keys in the pages' text tables."""
    return {key: words for check in CHECKS for key, words in check.texts().items()}
