"""Tests of the wing `care`."""
