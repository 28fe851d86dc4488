"""Receipts: what of a session was made, stored and is missing, computed from the record."""

from app.features.record.receipts.service import SessionReceipt, receipt_of, receipt_text

__all__ = [
    "SessionReceipt",
    "receipt_of",
    "receipt_text",
]
