"""Tests of headsets' self-tests."""
