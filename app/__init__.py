"""Reembody runs, watches and analyses VR re-embodiment studies."""

__version__ = "0.1.0"
