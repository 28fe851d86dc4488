"""Obstacles, their shapes and outlines."""
