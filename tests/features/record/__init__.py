"""Tests of the wing `record`."""
