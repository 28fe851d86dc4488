"""Scripted participants, who go through a session on this server so that newcomers can watch."""

from app.features.record.tryout.runner import TryoutRunner

__all__ = [
    "TryoutRunner",
]
