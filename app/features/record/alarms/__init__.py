"""What the operator has to know now: raised, cleared, and kept."""

from app.features.record.alarms.alarm import STANDING, Alarm, Change, Condition, Moment, WatchLimits
from app.features.record.alarms.service import (
    AlarmView,
    clear_all,
    open_alarms,
    open_rows,
    sessions_with_open_alarms,
    store_change,
)
from app.features.record.alarms.watch import QualityWatch

__all__ = [
    "STANDING",
    "Alarm",
    "AlarmView",
    "Change",
    "Condition",
    "Moment",
    "QualityWatch",
    "WatchLimits",
    "clear_all",
    "open_alarms",
    "open_rows",
    "sessions_with_open_alarms",
    "store_change",
]
