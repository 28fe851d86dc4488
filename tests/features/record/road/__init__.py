"""Tests of the study's road in a session."""
