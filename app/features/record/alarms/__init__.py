"""What the operator has to know now: raised, cleared, and kept."""

from app.features.record.alarms.alarm import STANDING, Alarm, Change, Condition, Moment, WatchLimits
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
    "STANDING",
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
