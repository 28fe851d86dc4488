"""The library of instruments: every version that was ever stored, and trying one out.

A version is named by the hash of its content and never changes.
"""

from app.features.design.instruments.service import (
    instrument_of,
    newest_instruments,
    parsed_instruments,
    save_instrument,
)

__all__ = ["instrument_of", "newest_instruments", "parsed_instruments", "save_instrument"]
