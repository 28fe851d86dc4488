"""Scripted participants, who go through a session on this server so that newcomers can watch."""

from app.features.record.tryout.desk import TryoutDesk

__all__ = [
    "TryoutDesk",
]
