"""Alarms: problems that the operator must know about now, raised, cleared and stored."""

from app.features.record.alarms.alarm import (
    PERSISTENT,
    Alarm,
    Change,
    Condition,
    Moment,
    WatchLimits,
)
from app.features.record.alarms.kinds import ALARMS, alarm_texts
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
    "ALARMS",
    "PERSISTENT",
    "Alarm",
    "AlarmView",
    "Change",
    "Condition",
    "Moment",
    "QualityWatch",
    "WatchLimits",
    "alarm_texts",
    "clear_all",
    "open_alarms",
    "open_rows",
    "sessions_with_open_alarms",
    "store_change",
]
