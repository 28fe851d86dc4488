"""Tests of the watch over the headset and of the alarms in the record."""
