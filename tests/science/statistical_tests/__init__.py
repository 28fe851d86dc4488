"""Tests of the registry of statistical tests."""
