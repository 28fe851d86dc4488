"""Receipts: the data that a session produced, stored and lacks, computed from its record."""

from app.features.record.receipts.service import SessionReceipt, receipt_of, receipt_text

__all__ = [
    "SessionReceipt",
    "receipt_of",
    "receipt_text",
]
