"""Receipts: the data that a session produced, stored and lacks, computed from its record."""

from app.features.record.receipts.service import SessionReceipt, receipt_of, receipt_text
from app.features.record.receipts.streams import Tallies

__all__ = [
    "SessionReceipt",
    "Tallies",
    "receipt_of",
    "receipt_text",
]
