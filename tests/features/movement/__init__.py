"""Tests of the wing `movement`."""
