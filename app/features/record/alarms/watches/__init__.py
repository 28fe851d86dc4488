"""Watches of one headset's data, each of which raises and clears alarms."""

from app.features.record.alarms.watches.backlog import BacklogWatch
from app.features.record.alarms.watches.clock import ClockWatch
from app.features.record.alarms.watches.silence import SilenceWatch
from app.features.record.alarms.watches.stream import StreamWatch

__all__ = ["BacklogWatch", "ClockWatch", "SilenceWatch", "StreamWatch"]
