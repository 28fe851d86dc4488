"""What the record holds about a person: removing it, and overwriting what is left of it."""

from app.features.record.erasure.overwriting import (
    expect_erasure,
    forget_erasure,
    is_overwritten,
    overwrite,
    overwrite_what_is_left,
)
from app.features.record.erasure.traces import remove_traces

__all__ = [
    "expect_erasure",
    "forget_erasure",
    "is_overwritten",
    "overwrite",
    "overwrite_what_is_left",
    "remove_traces",
]
