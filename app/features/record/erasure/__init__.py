"""Erase what the record contains about a person, and overwrite the bytes that remain on disk."""

from app.features.record.erasure.overwriting import (
    clear_erasure_mark,
    finish_overwriting,
    is_overwritten,
    mark_erasure,
    overwrite,
)
from app.features.record.erasure.traces import remove_traces

__all__ = [
    "clear_erasure_mark",
    "finish_overwriting",
    "is_overwritten",
    "mark_erasure",
    "overwrite",
    "remove_traces",
]
