"""Tests of the box tasks."""
