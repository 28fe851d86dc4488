"""The library of instruments: every stored version, and scoring answers on trial.

A version is identified by the hash of its content and never changes.
"""

from app.features.design.instruments.service import (
    faulty_instruments,
    instrument_of,
    newest_instruments,
    parsed_instruments,
    save_instrument,
)

__all__ = [
    "faulty_instruments",
    "instrument_of",
    "newest_instruments",
    "parsed_instruments",
    "save_instrument",
]
