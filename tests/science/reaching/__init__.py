"""Tests of how people reach."""
