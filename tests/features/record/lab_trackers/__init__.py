"""Tests of the trackers that a session's headset uses."""
