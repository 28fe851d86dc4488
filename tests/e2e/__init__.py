"""Tests through a real browser against the real server."""
