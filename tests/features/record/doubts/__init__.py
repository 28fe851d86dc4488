"""Doubts about what a headset says."""
