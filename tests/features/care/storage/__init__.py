"""Tests of disk usage."""
