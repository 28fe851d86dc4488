"""Tests of bringing trackers into the headset's world."""
