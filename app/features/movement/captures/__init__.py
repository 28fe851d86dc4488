"""Captures of movement: stored once, read, mapped, retargeted and verified."""
