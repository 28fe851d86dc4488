"""Shortest paths around obstacles."""
