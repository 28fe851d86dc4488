"""Tests of the wing `results`."""
