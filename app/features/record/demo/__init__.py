"""The demo lab: a study of its own with simulated participants, loaded and removed as a whole."""

from app.features.record.demo.runner import DemoRunner

__all__ = [
    "DemoRunner",
]
