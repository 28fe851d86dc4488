"""Humanoid models over HTTP."""
