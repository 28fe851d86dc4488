"""Scripted participants, who go through a session on this server so that newcomers can watch."""

from app.features.record.tryout.performance import Performance
from app.features.record.tryout.runner import TryoutRunner

__all__ = [
    "Performance",
    "TryoutRunner",
]
