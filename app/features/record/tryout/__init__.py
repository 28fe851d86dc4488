"""A scripted participant in this very server, so that newcomers see a session."""

from app.features.record.tryout.desk import TryoutDesk

__all__ = [
    "TryoutDesk",
]
