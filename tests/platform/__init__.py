"""Tests of `app/platform`."""
