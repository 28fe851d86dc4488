"""Tests of the wing `design`."""
